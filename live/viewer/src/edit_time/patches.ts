// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Gestures on the timeline as changes of the recipe. All times are those of the shown motion.
// Knows no elements of the page.

import type {Change} from '../edit/edit_document';
import {opName} from '../edit/edit_document';
import {stepsForFound} from '../edit/constraint_changes';
import {insertIndex} from '../edit/edit_view';
import type {Place, Shown, ShownView} from './op_times';
import {
  annotationTime, changeOf, duration_s, isAnnotating, lastOp, nextOp, offset_s, readInstant,
  spanPlace, startOfCut, tableAt, withInstant, withTable,
} from './op_times';
import type {AnnotationWords, OpKeys, OpStep, OpValue, OpWords, OutputWords}
  from '../protocol/edit_protocol';

/** Changes below this are none: recipes have milliseconds. */
const LEAST_S = 5e-4;
/** Operations whose whole frames are not resampled. */
const EXACT: readonly string[] = ['cut', 'keep', 'split'];
/** Fade of operations that are added over a span, so that the motion does not jump. */
const BLEND_S = 0.1;
const BLENDED: readonly string[] = ['filter', 'exaggerate', 'offset'];

/** The ends of a span within the shown motion; null for an end that is the motion's. */
function innerEnds(output: OutputWords, from_s: number, to_s: number):
  [number | null, number | null] {
  return [from_s > LEAST_S ? from_s : null, to_s < duration_s(output) - LEAST_S ? to_s : null];
}

function withSpan(keys: OpKeys, output: OutputWords, from_s: number, to_s: number,
  exact = false): OpKeys {
  const [from, to] = innerEnds(output, from_s, to_s);
  const out = from === null ? keys : withInstant(keys, 'from', from, output.rate_hz, exact);
  return to === null ? out : withInstant(out, 'to', to, output.rate_hz, exact);
}

/** Inserts an operation that receives the shown motion. */
function inserted({ops, until}: Shown, op: OpKeys): OpStep[] {
  return [{insert: insertIndex(ops, until), op}];
}

// --- Trim ---

/** Keeps this part of the shown motion. A cut or keep that made it is changed. */
export function trim(view: ShownView, from_s: number, to_s: number): Change {
  return changeOf(view, (shown) => {
    const [from, to] = innerEnds(shown.output, from_s, to_s);
    if (from === null && to === null) return null;
    return changedCut(shown, from, to) ?? inserted(shown,
      withSpan({do: 'cut@1'}, shown.output, from_s, to_s, true));
  });
}

/** Changes the preceding cut or keep. null: it does not exist, or its times are not known. */
function changedCut(shown: Shown, from: number | null, to: number | null): OpStep[] | null {
  const {ops, until, output} = shown;
  const index = Math.max(lastOp(ops, until, 'cut'), lastOp(ops, until, 'keep'));
  const place = index < 0 ? null : spanPlace(ops, index, shown.outputIndex);
  const start_s = place && startOfCut(shown, index);
  if (!place || start_s === null) return null;
  const {keys} = ops[index];
  let span = tableAt(keys, place)!;
  if (from !== null) span = withInstant(span, 'from', start_s + from, output.rate_hz, true);
  if (to !== null) span = withInstant(span, 'to', start_s + to, output.rate_hz, true);
  const steps: OpStep[] = [{replace: index, op: withTable(keys, place, span)}];
  const end_s = (to ?? duration_s(output)) - (from ?? 0);
  for (let i = index + 1; i < insertIndex(ops, until); ++i) {
    if (!isAnnotating(ops[i])) continue;
    const moved = shifted(ops[i].keys, -(from ?? 0), end_s, output.rate_hz);
    if (!moved && !ops[i].off) return null;
    // The same object: nothing has moved.
    if (moved && moved !== ops[i].keys) steps.push({replace: i, op: moved});
  }
  return steps;
}

/** Moves the times of a tag, event or curve. null: it would be outside of the motion. */
function shifted(keys: OpKeys, by_s: number, end_s: number, rate_hz: number): OpKeys | null {
  let out = keys;
  let isInside = true;
  const move = (place: Place, key: string, clamp: boolean): void => {
    const table = tableAt(out, place)!;
    const old = readInstant(table, key, rate_hz);
    if (typeof old !== 'number') return;
    const time_s = old + by_s;
    const kept_s = Math.min(Math.max(time_s, 0), end_s);
    if (Math.abs(kept_s - time_s) > LEAST_S && !clamp) isInside = false;
    if (Math.abs(kept_s - old) < LEAST_S) return;
    out = withTable(out, place, withInstant(table, key, kept_s, rate_hz));
  };
  const [from, to] = ['from', 'to'].map((key) => readInstant(keys, key, rate_hz));
  if (typeof from === 'number' && from + by_s > end_s + LEAST_S) return null;
  if (typeof to === 'number' && to + by_s < -LEAST_S) return null;
  move([], 'from', true);
  move([], 'to', true);
  move([], 'at', false);
  if (Array.isArray(keys.keys)) keys.keys.forEach((_, i) => move(['keys', i], 'at', false));
  return isInside ? out : null;
}

/** Removes a span at the start or the end of the motion. null: the span is in the middle,
 *  which no single operation can remove. */
export function removeSpan(view: ShownView, from_s: number, to_s: number): Change | null {
  if (!view.output) return null;
  const frame_s = 1 / view.output.rate_hz;
  const [from, to] = innerEnds(view.output, from_s, to_s);
  if ((from === null) === (to === null)) return null;
  return to === null ? trim(view, 0, from! - frame_s)
    : trim(view, to + frame_s, duration_s(view.output));
}

/** Keeps the span as a motion of its own, next to those of a keep that follows. */
export function keepSpan(view: ShownView, from_s: number, to_s: number): Change {
  return changeOf(view, (shown) => {
    const {ops, until, output: {rate_hz}} = shown;
    const span = withInstant(withInstant({}, 'from', from_s, rate_hz, true), 'to', to_s, rate_hz,
      true);
    const next = nextOp(ops, until, 'keep');
    if (next < 0) return inserted(shown, {do: 'keep@1', spans: [span]});
    const {keys} = ops[next];
    const spans = Array.isArray(keys.spans) ? keys.spans : [];
    return [{replace: next, op: {...keys, spans: [...spans, span]}}];
  });
}

// --- Operations over a span, and at instants ---

/** Adds an operation over a span of the shown motion. */
export function addOverSpan(view: ShownView, name: string, keys: Omit<OpKeys, 'do'>,
  from_s: number, to_s: number): Change {
  return changeOf(view, (shown) => {
    const op = withSpan({do: name}, shown.output, from_s, to_s);
    const fades = BLENDED.includes(opName(op)) && Object.keys(op).length > 1;
    return inserted(shown, {...op, ...keys, ...(fades && !('blend_s' in keys)
      ? {blend_s: BLEND_S} : {})} as OpKeys);
  });
}

/** Adds a curve that rises from 0 to 1 over a span. */
export function addCurve(view: ShownView, name: string, from_s: number, to_s: number): Change {
  return changeOf(view, (shown) => {
    const {rate_hz} = shown.output;
    return inserted(shown, {do: 'curve@1', name, keys: [
      {...withInstant({}, 'at', from_s, rate_hz), value: 0},
      {...withInstant({}, 'at', to_s, rate_hz), value: 1}]});
  });
}

/** Shown times by key, such as from, at; null: the key is removed. */
type Times = Readonly<Record<string, number | null>>;

/** Moves instants of operation `index`. */
export function moveInstants(view: ShownView, index: number, place: Place, times: Times): Change {
  const was = view.document.ops[index]?.do;
  return changeOf(view, (shown) => (shown.ops[index]?.do === was
    ? movedInstants(shown, index, place, times) : null));
}

function movedInstants(shown: Shown, index: number, place: Place, times: Times):
  OpStep[] | null {
  const op: OpWords | undefined = shown.ops[index];
  const by_s = offset_s(shown, index);
  let table = op ? tableAt(op.keys, place) : null;
  if (!table || by_s === null) return null;
  for (const [key, time_s] of Object.entries(times)) {
    table = withInstant(table, key, time_s === null ? null : Math.max(time_s + by_s, 0),
      shown.output.rate_hz, EXACT.includes(opName(op)));
  }
  return [{replace: index, op: withTable(op.keys, place, table)}];
}

/** Moves the span of operation `index`. null: this end is not changed. */
export function moveSpanOf(view: ShownView, index: number, from_s: number | null,
  to_s: number | null): Change {
  return moveInstants(view, index, [], {
    ...(from_s === null ? {} : {from: from_s}), ...(to_s === null ? {} : {to: to_s})});
}

// --- Constraints ---

/** Index of the operation that placed a constraint. -1: it is not a constraint of the recipe,
 *  or its times are unknown. */
export function opOfConstraint(shown: Shown, id: string): number {
  for (let i = insertIndex(shown.ops, shown.until) - 1; i >= 0; --i) {
    const op = shown.ops[i];
    if (op.off || opName(op) !== 'constrain') continue;
    if (tableAt(op.keys, ['constraint'])?.name !== id) continue;
    return offset_s(shown, i) === null ? -1 : i;
  }
  return -1;
}

/** Returns whether no operation of the recipe states this constraint itself. */
export function isFound(shown: Shown, id: string): boolean {
  return !shown.ops.some(({keys}) => tableAt(keys, ['constraint'])?.name === id);
}

/** Changes the start or stop of a constraint: in its own operation, or of a found one by hand.
 *  null: other times than those of its operation are shown. */
export function moveConstraintTime(view: ShownView, id: string, start_s: number | null,
  stop_s: number | null): Change {
  return changeOf(view, (shown) => {
    const {rate_hz} = shown.output;
    const index = opOfConstraint(shown, id);
    if (index < 0 && isFound(shown, id)) {
      let entry: Record<string, OpValue> = {};
      for (const [key, time_s] of [['start', start_s], ['stop', stop_s]] as const) {
        if (time_s !== null) entry = withInstant(entry, key, Math.max(time_s, 0), rate_hz);
      }
      return stepsForFound(shown.ops, shown.until, id, entry);
    }
    const by_s = index < 0 ? null : offset_s(shown, index);
    if (by_s === null) return null;
    let {keys} = shown.ops[index];
    let table = tableAt(keys, ['constraint'])!;
    for (const [key, common, time_s] of [['start', 'from', start_s], ['stop', 'to', stop_s]] as
      const) {
      if (time_s === null) continue;
      // An end of the operation's span would take precedence.
      keys = withInstant(keys, common, null, rate_hz);
      table = withInstant(table, key, Math.max(time_s + by_s, 0), rate_hz);
    }
    return [{replace: index, op: withTable(keys, ['constraint'], table)}];
  });
}

// --- Annotations ---

const notesOf = new WeakMap<readonly OpWords[], Map<OpValue, number[]>>();

/** Indices of the tags and events that are on, by their texts. Computed once per recipe. */
function notesByText(ops: readonly OpWords[]): Map<OpValue, number[]> {
  const known = notesOf.get(ops);
  if (known) return known;
  const made = new Map<OpValue, number[]>();
  ops.forEach((op, i) => {
    if (op.off || !['tag', 'event'].includes(opName(op))) return;
    const same = made.get(op.keys.text);
    if (same) same.push(i);
    else made.set(op.keys.text, [i]);
  });
  notesOf.set(ops, made);
  return made;
}

/** Index of the tag or event that an annotation comes from. -1: of none, or it is not clear
 *  of which one. */
export function opOfAnnotation(shown: Shown, note: AnnotationWords): number {
  const {ops, until, output} = shown;
  const end = insertIndex(ops, until);
  const same = (notesByText(ops).get(note.text) ?? []).filter((i) => i < end &&
    offset_s(shown, i) !== null);
  let best = -1;
  let least_s = 1 / output.rate_hz + 2 * LEAST_S;
  for (const i of same) {
    const {keys} = ops[i];
    const [start, end] = opName(ops[i]) === 'event' ? ['at', 'at'] : ['from', 'to'];
    const away_s = [[start, note.start_s, 'start', 0], [end, note.end_s, 'end', Infinity]] as const;
    const apart_s = Math.max(...away_s.map(([key, time_s, side, whole]) => {
      const at = readInstant(keys, key, output.rate_hz);
      const is_s = typeof at === 'string' ? annotationTime(output, at, side)
        : (at ?? whole) - offset_s(shown, i)!;
      if (is_s === null) return Infinity;
      return Math.abs(Math.min(Math.max(is_s, 0), duration_s(output)) - time_s);
    }));
    if (apart_s <= least_s) [best, least_s] = [i, apart_s];
  }
  if (best >= 0 || same.length !== 1) return best;
  return output.annotations.filter(({text}) => text === note.text).length === 1 ? same[0] : -1;
}

/** Moves an annotation that a tag or event of the recipe makes. */
export function moveAnnotation(view: ShownView, note: AnnotationWords, start_s: number,
  end_s: number): Change {
  return changeOf(view, (shown) => {
    const index = opOfAnnotation(shown, note);
    if (index < 0) return null;
    const from = Math.abs(start_s - note.start_s) < LEAST_S ? null : start_s;
    const to = Math.abs(end_s - note.end_s) < LEAST_S ? null : end_s;
    if (from === null && to === null) return null;
    if (opName(shown.ops[index]) === 'event') {
      return movedInstants(shown, index, [], {at: from ?? to});
    }
    return movedInstants(shown, index, [], {...(from === null ? {} : {from}),
      ...(to === null ? {} : {to})});
  });
}
