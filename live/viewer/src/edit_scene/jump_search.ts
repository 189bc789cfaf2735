// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Lowest points within the search space of a push, and the changes of a recipe that the jump
// panel makes.

import type {Change} from '../edit/edit_document';
import {insertIndex} from '../edit/edit_view';
import {opToChange} from './op_to_change';
import {haveSameTimes} from '../ops/op_origins';
import {completed, changedOp} from '../ops/op_rules';
import type {Changes} from '../ops/op_values';
import type {FoundJumpWords, JumpWords, LowestWords, OpKeys, OpStep, OpWords, SpaceColumnWords}
  from '../protocol/edit_protocol';
import {fixed} from '../base/words';

/** Columns farther apart than this many steps have empty ones between them. */
const GAP_STEPS = 1.5;
/** Decimals of a lowest point in a recipe: a thousandth of the push, and 0.1 mm. */
const AT_STEPS = 1e3;
const HEIGHT_STEPS = 1e4;

/** Captured falls that differ more from gravity are unusual. [m/s²] */
const FALL_TOLERANCE_M_S2 = 1;

/** Returns the parts of a space without empty columns between them. */
export function islandsOf(space: readonly SpaceColumnWords[]): SpaceColumnWords[][] {
  let step = Infinity;
  for (let i = 1; i < space.length; ++i) step = Math.min(step, space[i][0] - space[i - 1][0]);
  const out: SpaceColumnWords[][] = [];
  space.forEach((column, i) => {
    if (i === 0 || column[0] - space[i - 1][0] > GAP_STEPS * step) out.push([]);
    out[out.length - 1].push(column);
  });
  return out;
}

/** Returns the lowest and the highest point at this share of the push, linear between columns.
 *  Precondition: `at` is between the first and the last column of the island. */
export function heightsAt(island: readonly SpaceColumnWords[], at: number): [number, number] {
  const k = Math.max(island.findIndex(([x]) => x >= at), 0);
  const [x1, low1, high1] = island[k];
  const [x0, low0, high0] = island[Math.max(k - 1, 0)];
  const share = x1 > x0 ? (at - x0) / (x1 - x0) : 1;
  return [low0 + share * (low1 - low0), high0 + share * (high1 - high0)];
}

/** Rounds to a multiple of 1 / steps within [low, high]; the middle if none is within. */
function roundedWithin(value: number, low: number, high: number, steps: number): number {
  const first = Math.ceil(low * steps - 1e-9);
  const last = Math.floor(high * steps + 1e-9);
  if (first > last) return (low + high) / 2;
  return Math.min(Math.max(Math.round(value * steps), first), last) / steps;
}

/** Returns the point of the space above or below the wanted one, rounded as in a recipe; next
 *  to the space, the point at its nearer end. null: the space is empty. */
export function clampToSpace(space: readonly SpaceColumnWords[], {at, height_m}: LowestWords):
  LowestWords | null {
  let best: SpaceColumnWords[] | null = null;
  let away = Infinity;
  for (const island of islandsOf(space)) {
    const [first, last] = [island[0][0], island[island.length - 1][0]];
    const distance = Math.max(first - at, at - last, 0);
    if (distance < away) [best, away] = [island, distance];
  }
  if (!best) return null;
  const within = roundedWithin(at, best[0][0], best[best.length - 1][0], AT_STEPS);
  const [low, high] = heightsAt(best, within);
  return {at: within, height_m: roundedWithin(height_m, low, high, HEIGHT_STEPS)};
}

// --- Operations ---

function isJump(op: OpWords | undefined): boolean {
  return op?.do.startsWith('jump@') ?? false;
}

/** Returns the index of the jump that the panel shows: the selected operation, or the one that
 *  made the shown motion; or null. */
export function shownJump(ops: readonly OpWords[], selected: number | null,
  until: number | null): number | null {
  if (selected !== null && isJump(ops[selected])) return selected;
  return opToChange(ops, insertIndex(ops, until), 'jump@1');
}

/** Returns the change of keys of a jump at this index, with the keys that it needs or excludes;
 *  null if the operation has become another one. */
export function keysChange(index: number, changes: Changes): Change {
  return (ops) => {
    const op = ops[index];
    if (!isJump(op)) return null;
    return [{replace: index, op: changedOp(op.keys, completed(op.keys, changes))}];
  };
}

export function lowestChange(index: number, {at, height_m}: LowestWords): Change {
  return keysChange(index, {lowest: {at, height_m}});
}

/** Returns the steps that insert a jump behind the shown motion, and its index. */
export function insertedJump(ops: readonly OpWords[], until: number | null, keys: OpKeys):
  {index: number; steps: OpStep[]} {
  const index = insertIndex(ops, until);
  return {index, steps: [{insert: index, op: keys}]};
}

/** Returns whether the shown motion has the times of the result of operation `index`. */
export function showsTimesAfter(ops: readonly OpWords[], index: number, until: number | null):
  boolean {
  const shown = until ?? ops.length;
  return shown > index && haveSameTimes(ops, index + 1, shown);
}

// --- Words ---

export function fallsUnusually({fall_m_s2}: FoundJumpWords, gravity_m_s2 = 9.81): boolean {
  return fall_m_s2 !== 0 && Math.abs(fall_m_s2 + gravity_m_s2) > FALL_TOLERANCE_M_S2;
}

/** The columns of a row of the list: time, time in the air, rise, fall. */
export function jumpWords(jump: FoundJumpWords): [string, string, string, string] {
  return [`${fixed(jump.takeoff_s, 2)} s`,
    jump.airtime_s === null ? 'cut off' : `${fixed(jump.airtime_s, 2)} s`,
    `${fixed(100 * jump.rise_m, 1)} cm`,
    jump.fall_m_s2 === 0 ? '–' : `${fixed(jump.fall_m_s2, 1)} m/s²`];
}

const RULE_WORDS = {force: 'the push would be negative', fall: 'the body would rise before P2',
  rise: 'the body would sink after P2'};

/** Describes a lowest point, and the rule if it is at the edge of the space. */
export function lowestWords(space: readonly SpaceColumnWords[], {at, height_m}: LowestWords):
  string {
  const place = `P2 at ${fixed(100 * at, 0)} % of the push, ${fixed(height_m, 3)} m high`;
  const island = islandsOf(space).find((one) => one[0][0] <= at &&
    at <= one[one.length - 1][0]);
  if (!island) return `${place}.`;
  const [low, high] = heightsAt(island, at);
  const column = island.reduce((a, b) => (Math.abs(b[0] - at) < Math.abs(a[0] - at) ? b : a));
  const edge_m = 1.5 / HEIGHT_STEPS;
  if (height_m - low < edge_m) return `${place}; deeper, ${RULE_WORDS[column[3]]}.`;
  if (high - height_m < edge_m) return `${place}; higher, ${RULE_WORDS[column[4]]}.`;
  return `${place}; possible: ${fixed(low, 3)} to ${fixed(high, 3)} m.`;
}

/** Returns the largest push between two times, in g; null: it is unknown. */
export function peakOf({push_g, time_s}: Pick<JumpWords, 'push_g' | 'time_s'>, from_s: number,
  to_s: number): number | null {
  return push_g.reduce((peak: number | null, value, i) =>
    (value === null || time_s[i] < from_s || time_s[i] > to_s ? peak
      : Math.max(peak ?? value, value)), null);
}

/** Figures of the new jump in a line. */
export function planWords(words: JumpWords): string {
  const {phases} = words;
  if (!phases) return '';
  const {start_s, takeoff_s, landing_s, end_s} = phases;
  const part = (name: string, from_s: number, to_s: number): string => {
    const peak = peakOf(words, from_s, to_s);
    return `${name} ${fixed(to_s - from_s, 2)}\u00a0s` +
      (peak === null ? '' : ` with up to ${fixed(peak, 1)}\u00a0g`);
  };
  return `${part('Push', start_s, takeoff_s)}, ${fixed(landing_s - takeoff_s, 2)}\u00a0s in the ` +
    `air, ${part('landing', landing_s, end_s)}.`;
}
