// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Finds operations again after a change of the recipe.

import type {OpStep, OpWords} from '../protocol/edit_protocol';

/** For each operation of the new list, its index in the old one; −1: it is new. */
export type Origins = number[];

/** Returns the origins after a patch of a list of `count` operations. */
export function originsOfPatch(count: number, steps: readonly OpStep[]): Origins {
  const origins = Array.from({length: count}, (_, i) => i);
  for (const step of steps) {
    if ('insert' in step) origins.splice(step.insert, 0, -1);
    else if ('remove' in step) origins.splice(step.remove, 1);
    else if ('move' in step) origins.splice(step.to, 0, ...origins.splice(step.move, 1));
  }
  return origins;
}

type Known = Pick<OpWords, 'do' | 'off' | 'text'>;

function pair(origins: Origins, free: Set<number>, before: readonly Known[],
  after: readonly Known[], nameOf: (op: Known) => string): void {
  const places = new Map<string, number[]>();
  for (const i of free) {
    const name = nameOf(before[i]);
    const list = places.get(name);
    if (list) list.push(i);
    else places.set(name, [i]);
  }
  const used = new Map<string, number>();
  origins.forEach((origin, j) => {
    if (origin >= 0) return;
    const name = nameOf(after[j]);
    const at = used.get(name) ?? 0;
    const found = places.get(name)?.[at];
    if (found === undefined) return;
    used.set(name, at + 1);
    origins[j] = found;
    free.delete(found);
  });
}

/** Returns the most likely origins if only both lists are known: equal beginnings and ends,
 *  then equal texts, then operations of the same kind in their order. */
export function originsOf(before: readonly Known[], after: readonly Known[]): Origins {
  const origins: Origins = after.map(() => -1);
  const isEqual = (i: number, j: number): boolean => before[i].text === after[j].text;
  const shorter = Math.min(before.length, after.length);
  let head = 0;
  while (head < shorter && isEqual(head, head)) origins[head] = head++;
  let tail = 0;
  while (tail < shorter - head && isEqual(before.length - 1 - tail, after.length - 1 - tail)) {
    tail += 1;
    origins[after.length - tail] = before.length - tail;
  }
  const free = new Set<number>();
  for (let i = head; i < before.length - tail; ++i) free.add(i);
  pair(origins, free, before, after, ({text}) => text);
  // A changed operation at the same place, then one that has changed and moved.
  if (before.length === after.length) {
    origins.forEach((origin, j) => {
      if (origin >= 0 || !free.has(j) || before[j].do !== after[j].do) return;
      origins[j] = j;
      free.delete(j);
    });
  }
  pair(origins, free, before, after, (op) => op.do);
  return origins;
}

/** Returns the index for "move" of an operation that is dropped before another one. `before` =
 *  number of operations: at the end. null: it stays in place. */
export function moveTarget(from: number, before: number): number | null {
  const to = before > from ? before - 1 : before;
  return to === from ? null : to;
}

const TIME_CHANGES = new Set(['cut', 'keep', 'split', 'splice', 'retime', 'scale_time', 'cyclify',
  'jump']);

/** True if instants are the same in the motions that have the first `a` and the first `b`
 *  operations. */
export function haveSameTimes(ops: readonly Pick<OpWords, 'do' | 'off'>[], a: number, b: number):
  boolean {
  return ops.slice(Math.min(a, b), Math.max(a, b)).every((op) =>
    op.off || !TIME_CHANGES.has(op.do.split('@')[0]));
}
