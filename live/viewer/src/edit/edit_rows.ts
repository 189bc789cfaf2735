// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Rows and curves of the edited motion for the timeline.

import type {AnnotationWords, EditGraphWords, OutputWords} from '../protocol/edit_protocol';
import {SOURCES} from '../protocol/protocol';
import type {GraphData} from '../timeline/graph';
import type {Strip, TimelineData} from '../timeline/timeline_paint';
import {ROW_PX, sourceStrip} from '../timeline/timeline_paint';
import type {Curve, Run} from '../timeline/timeline_rows';
import {BEARS, RunRows} from '../timeline/timeline_rows';

const rowsOf = new WeakMap<readonly AnnotationWords[], AnnotationWords[][]>();
/** Frames that an operation has changed are drawn in the colour of repaired ones. */
const CHANGED = 1;

/** Returns the rows and curves of an output. `op`: the selected operation, whose frames have a
 *  row of their own; null: none. */
export function editTimeline(output: OutputWords, op: number | null): TimelineData {
  const trust = new RunRows(['invented by the edit'], [output.trust.map(([first, last, source]) =>
    [first, last, SOURCES.indexOf(source)])]);
  const tracks = output.tracks.length === 0 ? trust : new RunRows(
    output.tracks.map(({name}) => name), output.tracks.map(({gaps}) => gaps.map(
      ([first, last, source]) => [first, last, SOURCES.indexOf(source)])));
  const strips = [contactStrip(output), constraintStrip(output), annotationStrip(output),
    sourceStrip(trust)];
  if (op !== null) strips.push(changedStrip(output, op));
  if (output.tracks.length > 0) strips.push(sourceStrip(tracks));
  return {strips, summary: tracks, graphs: editGraphs(output), rate_hz: output.rate_hz,
    first_frame: 0, live: false, notes: output.annotations.map(({text, start_s}) =>
      ({frame: start_s * output.rate_hz, text}))};
}

/** Curves of the result, with the source's behind them. */
export function editGraphs({graphs, value_curves, span}: OutputWords): GraphData[] {
  return [
    ...graphs.map((graph) => ({name: graph.name, unit: graph.unit, curves: [
      spanCurve(graph.values, span[0]), ...beforeCurve(graph, span[0])]})),
    ...value_curves.map(({name, values}) => ({name, unit: '', curves: [
      spanCurve(values, span[0])]})),
  ];
}

function spanCurve(values: readonly (number | null)[], first: number,
  look: Pick<Curve, 'colour' | 'dash' | 'width'> = {}): Curve {
  return {first, end: first + values.length, at: (frame) => values[frame - first] ?? null, ...look};
}

function beforeCurve({before}: EditGraphWords, first: number): Curve[] {
  return before.some((value) => value !== null)
    ? [spanCurve(before, first, {colour: 'quiet', dash: [4, 3], width: 1})] : [];
}

function contactStrip({contacts}: OutputWords): Strip {
  const rows = new RunRows(contacts.map(({name}) => name), contacts.map(({spans}) =>
    spans.map(([first, last]) => [first, last, BEARS])));
  const bearing = {colour: 'ink', top: 2, height: ROW_PX - 6};
  return {kind: 'contacts', rows, base: 'seen-none', looks: [bearing, bearing],
    words: (row, frame) => `${rows.names[row]}` +
      `${rows.source(row, frame) === BEARS ? ': bears' : ''}`};
}

/** Constraints fade in and out; the row has their whole span. */
function constraintStrip({constraints, rate_hz, frames}: OutputWords): Strip {
  const rows = new RunRows(constraints.map(({id}) => id), constraints.map(
    ({start_s, stop_s}): Run[] => [[start_s === null ? 0 : start_s * rate_hz,
      stop_s === null ? frames - 1 : stop_s * rate_hz, CHANGED]]));
  const active = {colour: 'accent', top: 2, height: ROW_PX - 6, least: 2};
  return {kind: 'constraints', rows, base: 'seen-none', looks: [active, active],
    words: (row) => {
      const {id, segment, kind} = constraints[row];
      return `${id}: ${kind} of ${segment}`;
    }};
}

/** Annotations of the same text share a row. Computed once per result. */
function byText(annotations: readonly AnnotationWords[]): AnnotationWords[][] {
  const known = rowsOf.get(annotations);
  if (known) return known;
  const rows = new Map<string, AnnotationWords[]>();
  for (const note of annotations) {
    const same = rows.get(note.text);
    if (same) same.push(note);
    else rows.set(note.text, [note]);
  }
  const made = [...rows.values()];
  rowsOf.set(annotations, made);
  return made;
}

/** Returns the annotations in a row of the timeline. */
export function annotationsInRow(annotations: readonly AnnotationWords[],
  row: number): readonly AnnotationWords[] {
  return byText(annotations)[row] ?? [];
}

function annotationStrip({annotations, rate_hz}: OutputWords): Strip {
  const sorted = byText(annotations);
  const texts = sorted.map(([{text}]) => text);
  const rows = new RunRows(texts, sorted.map((same) => same.map(({start_s, end_s}): Run =>
    [start_s * rate_hz, end_s * rate_hz, CHANGED])));
  const noted = {colour: 'good', top: 3, height: ROW_PX - 8, least: 3};
  return {kind: 'annotations', rows, base: 'seen-none', looks: [noted, noted],
    words: (row) => texts[row]};
}

function changedStrip({touched}: OutputWords, op: number): Strip {
  const rows = new RunRows([`changed by ${op + 1}`], [touched.filter(([, , ops]) =>
    ops.includes(op)).map(([first, last]): Run => [first, last, CHANGED])]);
  const changed = {colour: 'repaired', top: 2, height: ROW_PX - 6};
  return {kind: 'ops', rows, base: 'seen-none', looks: [changed, changed],
    words: (row, frame) => `${rows.names[row]}${rows.source(row, frame) ? '' : ': unchanged'}`};
}
