// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Handles on the timeline: ends of the motion, instants of the selected operation, edges of
// contacts and constraints, annotations. Knows no elements of the page.

import {annotationsInRow} from '../edit/edit_rows';
import {moveContactEdge} from './contact_patches';
import type {Change} from '../edit/edit_document';
import {opHandles} from './op_handles';
import type {Shown, ShownView} from './op_times';
import {nextOp, rounded, shownBy, shownFrame} from './op_times';
import {
  isFound, moveAnnotation, moveConstraintTime, moveSpanOf, opOfAnnotation, opOfConstraint, trim,
} from './patches';
import type {
  AnnotationWords, EditConstraintWords, EditContactWords,
} from '../protocol/edit_protocol';
import {fixed} from '../base/words';

/** `axis`, or the kind of a strip. */
export type HandlePlace = 'axis' | 'contacts' | 'constraints' | 'annotations';

export interface Handle {
  readonly where: HandlePlace;
  /** Row of the strip. */
  readonly row: number;
  readonly role: 'trim' | 'op' | 'mark' | 'edge';
  /** `start` and `end` of a span; `point`: an instant; `span`: both ends move. */
  readonly side: 'start' | 'end' | 'point' | 'span';
  /** The frame that it moves; the first one of a span. May have a fraction. */
  readonly frame: number;
  /** Distance at which it is drawn: bars include half a frame on each side. [frames] */
  readonly shift: number;
  /** Frames of a span. */
  readonly frames?: number;
  /** Smallest and largest frame. */
  readonly low: number;
  readonly high: number;
  readonly name: string;
  /** Shows the changed motion during a drag. */
  readonly previews: boolean;
  /** Returns the change that moves it to a frame; null: none. */
  change(frame: number): Change | null;
  /** Text instead of the time at this frame. */
  words?(frame: number): string | null;
}

export type Made = Partial<Handle> & Pick<Handle, 'side' | 'frame' | 'name' | 'change'>;

export function handle(shown: Shown, made: Made): Handle {
  return {where: 'axis', row: 0, role: 'op', shift: 0, low: 0, high: shown.output.frames - 1,
    previews: true, ...made};
}

/** The handles on the axis, or in one row. `selected`: index of the selected operation.
 *  `frames`: on the axis, annotations outside of these are left out, of which there may be
 *  thousands. */
export function handlesIn(view: ShownView, selected: number | null, where: HandlePlace,
  row: number, [low, high]: readonly [number, number] = [-Infinity, Infinity]): Handle[] {
  const shown = shownBy(view);
  if (!shown || shown.output.frames < 2) return [];
  const {contacts, constraints, annotations} = shown.output;
  if (where !== 'axis') {
    if (where === 'annotations') {
      return annotationsInRow(annotations, row).flatMap((note) =>
        annotationHandles(view, shown, note, row));
    }
    if (row >= shown.output[where].length) return [];
    if (where === 'contacts') return contactHandles(view, shown, contacts[row], row);
    return constraintHandles(view, shown, constraints[row], row);
  }
  const marks = annotations.filter(({start_s, end_s}) => start_s === end_s &&
    start_s * shown.output.rate_hz >= low && start_s * shown.output.rate_hz <= high);
  return [...axisHandles(view, selected), ...marks.flatMap((note) =>
    annotationHandles(view, shown, note, 0).map((mark) => ({...mark, where})))];
}

/** The handles on the axis that are drawn: without those of annotations. */
export function axisHandles(view: ShownView, selected: number | null): Handle[] {
  const shown = shownBy(view);
  if (!shown || shown.output.frames < 2) return [];
  return [...trimHandles(view, shown),
    ...(selected === null ? [] : opHandles(view, shown, selected))];
}

/** "start of left heel 1.283 s (−27 ms)" */
export function handleWords({name, frame, words}: Pick<Handle, 'name' | 'frame' | 'words'>,
  now: number, rate_hz: number): string {
  const told = words?.(now);
  if (told) return told;
  const moved_ms = rounded((now - frame) / rate_hz * 1000, 0);
  const moved = moved_ms === 0 ? '' : ` (${moved_ms > 0 ? '+' : ''}${fixed(moved_ms, 0)} ms)`;
  return `${name} ${fixed(now / rate_hz, 3)} s${moved}`;
}

// --- Ends of the motion ---

/** First and last kept frame: those of a cut that receives the shown motion, or all. null: an
 *  end that is not known. */
export function trimmedFrames(shown: Shown): [number | null, number | null] {
  const {ops, until, output} = shown;
  const cut = nextOp(ops, until, 'cut');
  if (cut < 0) return [0, output.frames - 1];
  return [shownFrame(shown, cut, [], 'from', 0),
    shownFrame(shown, cut, [], 'to', output.frames - 1)];
}

function trimHandles(view: ShownView, shown: Shown): Handle[] {
  const {ops, until, output: {rate_hz, frames}} = shown;
  const [from, to] = trimmedFrames(shown);
  const cut = nextOp(ops, until, 'cut');
  const made = {role: 'trim' as const, previews: false};
  const start = from === null ? [] : [handle(shown, {...made, side: 'start', frame: from,
    high: (to ?? frames - 1) - 1, name: 'start of the motion',
    change: (frame) => (cut < 0 ? trim(view, frame / rate_hz, (frames - 1) / rate_hz)
      : moveSpanOf(view, cut, frame / rate_hz, null))})];
  const end = to === null ? [] : [handle(shown, {...made, side: 'end', frame: to,
    low: (from ?? 0) + 1, name: 'end of the motion',
    change: (frame) => (cut < 0 ? trim(view, 0, frame / rate_hz)
      : moveSpanOf(view, cut, null, frame / rate_hz))})];
  return [...start, ...end];
}

// --- Contacts, constraints, annotations ---

function contactHandles(view: ShownView, shown: Shown, contact: EditContactWords, row: number):
  Handle[] {
  const {rate_hz} = shown.output;
  const {foot, part, name} = contact;
  return contact.spans.flatMap(([first, last]) => (['start', 'end'] as const).map((edge) => {
    const [frame, other] = edge === 'start' ? [first, last] : [last, first];
    return handle(shown, {where: 'contacts', row, role: 'edge', side: edge, frame,
      shift: edge === 'start' ? -0.5 : 0.5, name: `${edge} of ${name}`,
      change: (now) => moveContactEdge(view, {foot, part, edge, other_s: other / rate_hz},
        frame / rate_hz, now / rate_hz),
      words: (now) => ((edge === 'start' ? now > other + 0.5 : now < other - 0.5)
        ? `${name}: contact is cleared` : null)});
  }));
}

function constraintHandles(view: ShownView, shown: Shown, words: EditConstraintWords,
  row: number): Handle[] {
  if (opOfConstraint(shown, words.id) < 0 && !isFound(shown, words.id)) return [];
  const {rate_hz, frames} = shown.output;
  const start = (words.start_s ?? 0) * rate_hz;
  const stop = (words.stop_s ?? (frames - 1) / rate_hz) * rate_hz;
  const made = {where: 'constraints' as const, row, role: 'edge' as const};
  const all = [
    handle(shown, {...made, side: 'start', frame: start, high: stop, name: `start of ${words.id}`,
      change: (now) => moveConstraintTime(view, words.id, now / rate_hz, null)}),
    handle(shown, {...made, side: 'end', frame: stop, low: start, name: `stop of ${words.id}`,
      change: (now) => moveConstraintTime(view, words.id, null, now / rate_hz)}),
  ];
  return all.filter(({frame}) => frame >= -0.5 && frame <= frames - 0.5);
}

function annotationHandles(view: ShownView, shown: Shown, note: AnnotationWords, row: number):
  Handle[] {
  if (opOfAnnotation(shown, note) < 0) return [];
  const {rate_hz} = shown.output;
  const [start, end] = [note.start_s * rate_hz, note.end_s * rate_hz];
  const made = {where: 'annotations' as const, row, role: 'mark' as const};
  if (start === end) {
    return [handle(shown, {...made, side: 'point', frame: start, name: note.text,
      change: (now) => moveAnnotation(view, note, now / rate_hz, now / rate_hz)})];
  }
  return [
    handle(shown, {...made, side: 'start', frame: start, high: end, name: `start of ${note.text}`,
      change: (now) => moveAnnotation(view, note, now / rate_hz, note.end_s)}),
    handle(shown, {...made, side: 'end', frame: end, low: start, name: `end of ${note.text}`,
      change: (now) => moveAnnotation(view, note, note.start_s, now / rate_hz)}),
  ];
}
