// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The instants and spans of the selected operation that can be dragged on the timeline. Knows
// no elements of the page.

import {opName} from '../edit/edit_document';
import {insertIndex} from '../edit/edit_view';
import type {Place, Shown, ShownView} from './op_times';
import {offset_s, SPANNED, shownFrame} from './op_times';
import {moveInstants} from './patches';
import type {Handle, Made} from './timeline_handles';
import type {OpWords} from '../protocol/edit_protocol';

interface NamedSpan {place: Place; from: string; to: string; name: string}
interface NamedPoint {place: Place; key: string; name: string}

/** Operations whose instant `at` is one of the motion that they receive. */
const AT: readonly string[] = ['pose', 'event', 'place', 'splice'];
/** Their lists of instants. */
const LISTS: Readonly<Record<string, readonly [list: string, name: string]>> = {
  curve: ['keys', 'key'], retime: ['knots', 'knot'], split: ['instants', 'division']};

function listed({keys}: OpWords, list: string): number[] {
  return Array.isArray(keys[list]) ? keys[list].map((_, i) => i) : [];
}

function has({keys}: OpWords, key: string): boolean {
  return [key, `${key}_s`, `${key}_frame`].some((name) => name in keys);
}

/** A cut has none: the handles at the ends of the motion are those of its span. */
function spansOf(op: OpWords): NamedSpan[] {
  const name = opName(op);
  if (name === 'keep') {
    return listed(op, 'spans').map((i) => ({place: ['spans', i], from: 'from', to: 'to',
      name: `span ${i + 1}`}));
  }
  if (name === 'cyclify' && has(op, 'cycle_from')) {
    return [{place: [], from: 'cycle_from', to: 'cycle_to', name: 'cycle'}];
  }
  const isSpanned = SPANNED.includes(name) || has(op, 'from') || has(op, 'to');
  return isSpanned && name !== 'cut' && name !== 'constrain'
    ? [{place: [], from: 'from', to: 'to', name}] : [];
}

function pointsOf(op: OpWords): NamedPoint[] {
  const name = opName(op);
  if (AT.includes(name) && has(op, 'at')) return [{place: [], key: 'at', name}];
  const [list, word] = LISTS[name] ?? ['', ''];
  return listed(op, list).map((i) => ({place: [list, i], key: 'at', name: `${word} ${i + 1}`}));
}

/** First and last frames of the spans of an operation, as far as they are known. */
export function spansOfOp(shown: Shown, index: number): (NamedSpan & {frames: [number, number]})[] {
  const op: OpWords | undefined = shown.ops[index];
  if (!op) return [];
  return spansOf(op).flatMap((span) => {
    const from = shownFrame(shown, index, span.place, span.from, 0);
    const to = shownFrame(shown, index, span.place, span.to, shown.output.frames - 1);
    return from === null || to === null || from > to ? []
      : [{...span, frames: [from, to] as [number, number]}];
  });
}

export function opHandles(view: ShownView, shown: Shown, index: number): Handle[] {
  const op: OpWords | undefined = shown.ops[index];
  if (!op || offset_s(shown, index) === null) return [];
  const {output: {rate_hz, frames}, ops, until} = shown;
  const base = {where: 'axis' as const, row: 0, role: 'op' as const, shift: 0, low: 0,
    high: frames - 1, previews: !op.off && index < insertIndex(ops, until)};
  const made = (part: Made): Handle => ({...base, ...part});
  const spans = spansOfOp(shown, index).flatMap(({place, from, to, name, frames: span}) => {
    const [first, last] = span;
    return [
      made({side: 'start', frame: first, high: last, name: `start of ${name}`,
        change: (now) => moveInstants(view, index, place, {[from]: now / rate_hz})}),
      made({side: 'end', frame: last, low: first, name: `end of ${name}`,
        change: (now) => moveInstants(view, index, place, {[to]: now / rate_hz})}),
      made({side: 'span', frame: first, frames: last - first, high: frames - 1 - (last - first),
        name, change: (now) => moveInstants(view, index, place,
          {[from]: now / rate_hz, [to]: (now + last - first) / rate_hz})})];
  });
  const points = pointsOf(op);
  const at = points.map(({place, key}) => shownFrame(shown, index, place, key, null));
  return [...spans, ...points.flatMap(({place, key, name}, i) => {
    const frame = at[i];
    if (frame === null || frame < 0 || frame > frames - 1) return [];
    // Instants of a list ascend.
    const low = i > 0 ? (at[i - 1] ?? -1) + 1 : 0;
    const high = i + 1 < at.length ? (at[i + 1] ?? frames) - 1 : frames - 1;
    return [made({side: 'point', frame, low: Math.min(low, frame), high: Math.max(high, frame),
      name, change: (now) => moveInstants(view, index, place, {[key]: now / rate_hz})})];
  })];
}
