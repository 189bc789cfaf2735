// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Instants of operations: reading, writing, and converting them between the motion that an
// operation receives and the shown one. Knows no elements of the page.

import type {Change} from '../edit/edit_document';
import {opName} from '../edit/edit_document';
import type {EditView} from '../edit/edit_view';
import {insertIndex} from '../edit/edit_view';
import type {
  EditSourceWords, OpKeys, OpStep, OpValue, OpWords, OutputWords,
} from '../protocol/edit_protocol';

/** The shown motion, and the operations when a change is computed. */
export interface Shown {
  ops: readonly OpWords[]; sources: readonly EditSourceWords[]; until: number | null;
  output: OutputWords; outputIndex: number;
}

/** The part of an EditView that changes are computed from. */
export type ShownView = Pick<EditView, 'document' | 'until' | 'output' | 'outputIndex'>;

/** null: no motion is shown. */
export function shownBy(view: ShownView): Shown | null {
  const {document: {ops, revision}, until, output, outputIndex} = view;
  return output && {ops, sources: revision?.sources ?? [], until, output, outputIndex};
}

/** Returns a change for the motion that is shown now. */
export function changeOf(view: ShownView, make: (shown: Shown) => OpStep[] | null): Change {
  const shown = shownBy(view);
  return (ops) => shown && make({...shown, ops});
}

type Table = {[key: string]: OpValue};

/** A table of an operation with keys of instants: [] is the operation itself, ['keys', 2]
 *  the third key of a curve. */
export type Place = readonly (string | number)[];

/** A whole frame is kept to the bit; this near to one, an instant is on it. [frames] */
const ON_FRAME = 1e-6;
const SNAPPED_FRAMES = 1e-3;

/** Operations that annotate only: the poses after them are those before. */
const ANNOTATING: readonly string[] = ['tag', 'event', 'curve'];
/** Operations after which an instant has another time. Splices add to the end. */
const TIMED: readonly string[] = ['cut', 'keep', 'split', 'retime', 'scale_time', 'cyclify',
  'jump'];
/** Operations of which each one may have a span. */
export const SPANNED: readonly string[] = ['cut', 'filter', 'level', 'place', 'path', 'plant',
  'exaggerate', 'balance', 'jump', 'offset', 'tag'];

export function rounded(value: number, decimals = 3): number {
  const scale = 10 ** decimals;
  // Adding 0 turns -0 into 0.
  return Math.round(value * scale) / scale + 0;
}

export function isAnnotating(op: OpWords): boolean {
  return ANNOTATING.includes(opName(op));
}

export function duration_s(output: OutputWords): number {
  return Math.max(output.frames - 1, 0) / output.rate_hz;
}

// --- Reading and writing ---

export function tableAt(keys: OpKeys, place: Place): Table | null {
  let value: OpValue | undefined = keys;
  for (const step of place) {
    if (typeof value !== 'object') return null;
    value = (value as Record<string | number, OpValue>)[step];
  }
  return value !== undefined && typeof value === 'object' && !Array.isArray(value) ? value : null;
}

/** Returns a time, the name of an annotation, or null if the key is absent. */
export function readInstant(table: Table, key: string, rate_hz: number): number | string | null {
  const time = table[`${key}_s`];
  if (typeof time === 'number') return time;
  const frame = table[`${key}_frame`];
  if (typeof frame === 'number') return frame / rate_hz;
  const name = table[key];
  return typeof name === 'string' ? name : null;
}

/** Returns the key and value of an instant, in milliseconds. `exact`: an instant on a whole
 *  frame is a frame if milliseconds cannot state it; then the frame is not resampled. */
export function writtenInstant(key: string, time_s: number, rate_hz: number, exact = false):
  [string, number] {
  const short_s = rounded(time_s);
  const whole = Math.round(time_s * rate_hz);
  const onFrame = Math.abs(time_s * rate_hz - whole) <= SNAPPED_FRAMES;
  if (exact && onFrame && Math.abs(short_s * rate_hz - whole) > ON_FRAME) {
    return [`${key}_frame`, whole];
  }
  return [`${key}_s`, short_s];
}

/** Returns the table with another instant, at the position of the old one. null: without. */
export function withInstant<T extends Table>(table: T, key: string, time_s: number | null,
  rate_hz: number, exact = false): T {
  const names = [`${key}_s`, `${key}_frame`, key];
  const written = time_s === null ? null : writtenInstant(key, time_s, rate_hz, exact);
  const out: [string, OpValue][] = [];
  let isPlaced = false;
  for (const [name, value] of Object.entries(table)) {
    if (!names.includes(name)) out.push([name, value]);
    else if (written && !isPlaced) {
      out.push(written);
      isPlaced = true;
    }
  }
  if (written && !isPlaced) out.push(written);
  return Object.fromEntries(out) as T;
}

/** Returns the operation with another table at this place. */
export function withTable(keys: OpKeys, place: Place, table: Table): OpKeys {
  const put = (value: OpValue, at: number): OpValue => {
    if (at === place.length) return table;
    const step = place[at];
    if (Array.isArray(value)) {
      return value.map((item, i) => (i === step ? put(item, at + 1) : item));
    }
    const {[step]: inner, ...rest} = value as Table;
    return inner === undefined ? value : {...rest, [step]: put(inner, at + 1)};
  };
  return put(keys, 0) as OpKeys;
}

// --- Operations around the shown motion ---

/** Index of the last operation of this name that made the shown motion, if only annotations
 *  follow it. -1: none. Operations that are off do nothing. */
export function lastOp(ops: readonly OpWords[], until: number | null, name: string): number {
  for (let i = insertIndex(ops, until) - 1; i >= 0; --i) {
    if (ops[i].off || isAnnotating(ops[i])) continue;
    return opName(ops[i]) === name ? i : -1;
  }
  return -1;
}

/** Index of the operation of this name that receives the shown motion. -1: none. */
export function nextOp(ops: readonly OpWords[], until: number | null, name: string): number {
  if (until === null) return -1;
  for (let i = until; i < ops.length; ++i) {
    if (ops[i].off || isAnnotating(ops[i])) continue;
    return opName(ops[i]) === name ? i : -1;
  }
  return -1;
}

/** True if this operation makes several motions of each. */
function multiplies(op: OpWords): boolean {
  return !op.off && ['keep', 'split'].includes(opName(op));
}

/** Table of the span that the shown motion begins with, if operation `index` is a cut or keep;
 *  null if it cannot be known. */
export function spanPlace(ops: readonly OpWords[], index: number, outputIndex: number):
  Place | null {
  if (opName(ops[index]) === 'cut') return [];
  if (opName(ops[index]) !== 'keep' || ops.slice(0, index).some(multiplies)) return null;
  return tableAt(ops[index].keys, ['spans', outputIndex]) ? ['spans', outputIndex] : null;
}

/** Time in the input of the cut or keep `index` at which its result begins. null: unknown. */
export function startOfCut(shown: Shown, index: number): number | null {
  const {ops, output, outputIndex} = shown;
  const place = spanPlace(ops, index, outputIndex);
  if (!place) return null;
  const start = readInstant(tableAt(ops[index].keys, place)!, 'from', output.rate_hz);
  return typeof start === 'string' ? startFromLineage(shown, index) : start ?? 0;
}

/** The frame of the source with which the shown motion begins, minus the starts of all other
 *  cuts. null if there are other changes of time, or another unknown cut. */
function startFromLineage({ops, sources, until, output, outputIndex}: Shown,
  index: number): number | null {
  const end = until ?? ops.length;
  const [first, , source, from] = output.lineage[0] ?? [];
  if (index >= end || first !== 0 || source === undefined) return null;
  let start_s = from / (sources[source]?.rate_hz ?? output.rate_hz);
  for (let i = 0; i < end; ++i) {
    if (i === index || ops[i].off || !TIMED.includes(opName(ops[i]))) continue;
    const place = spanPlace(ops, i, outputIndex);
    const other = place && readInstant(tableAt(ops[i].keys, place)!, 'from', output.rate_hz);
    if (!place || typeof other === 'string') return null;
    start_s -= other ?? 0;
  }
  return start_s;
}

/** Time in the input of operation `index` at the first frame of the shown motion; null if the
 *  two differ by more than cuts. */
export function offset_s(shown: Shown, index: number): number | null {
  const {ops} = shown;
  const end = shown.until ?? ops.length;
  let sum_s = 0;
  for (let i = Math.min(index, end); i < Math.max(index, end); ++i) {
    if (ops[i].off || !TIMED.includes(opName(ops[i]))) continue;
    const start_s = startOfCut(shown, i);
    if (start_s === null) return null;
    sum_s += index < end ? start_s : -start_s;
  }
  return sum_s;
}

// --- Annotations ---

/** Returns the time of an annotation or a contact event in the shown motion. */
export function annotationTime(output: OutputWords, name: string, end: 'start' | 'end'):
  number | null {
  const [, text, number] = /^(.*?)(?:\[(\d+)\])?$/.exec(name) ?? [];
  const at = Number(number ?? 0);
  const notes = output.annotations.filter((note) => note.text === text);
  if (notes.length > 0) return notes[at]?.[`${end}_s`] ?? null;
  const [, foot, event] = /^(left|right)\.(strike|toe_off)$/.exec(text ?? '') ?? [];
  if (!foot) return null;
  const frames = stances(output, foot).map(([first, last]) => (event === 'strike' ? first : last))
    .filter((frame) => (event === 'strike' ? frame > 0 : frame < output.frames - 1));
  return frames[at] === undefined ? null : frames[at] / output.rate_hz;
}

/** Spans in which heel or ball of a foot bears. */
function stances({contacts}: OutputWords, foot: string): [number, number][] {
  const spans = contacts.filter((contact) => contact.foot === foot)
    .flatMap((contact) => contact.spans).sort((a, b) => a[0] - b[0]);
  const out: [number, number][] = [];
  for (const [first, last] of spans) {
    const before = out[out.length - 1];
    if (before && first <= before[1] + 1) before[1] = Math.max(before[1], last);
    else out.push([first, last]);
  }
  return out;
}

/** Frame in the shown motion of an instant of operation `index`. `absent`: without the key.
 *  null: not known. */
export function shownFrame(shown: Shown, index: number, place: Place, key: string,
  absent: number | null): number | null {
  const {output, ops} = shown;
  const by_s = offset_s(shown, index);
  const table = tableAt(ops[index].keys, place);
  if (by_s === null || !table) return null;
  const at = readInstant(table, key, output.rate_hz);
  if (at === null) return absent;
  const time_s = typeof at === 'number' ? at - by_s
    : annotationTime(output, at, key.endsWith('to') ? 'end' : 'start');
  if (time_s === null) return null;
  const frame = time_s * output.rate_hz;
  const whole = Math.round(frame);
  // Milliseconds of a recipe stand for whole frames.
  return Math.abs(frame - whole) < 6e-4 * output.rate_hz ? whole : frame;
}
