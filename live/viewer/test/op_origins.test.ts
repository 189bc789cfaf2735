// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Operations are found again after a change of the recipe.

import assert from 'node:assert/strict';
import test from 'node:test';
import {rowsAbove} from '../src/ops/op_drag';
import {haveSameTimes, moveTarget, originsOf, originsOfPatch} from '../src/ops/op_origins';
import type {OpStep} from '../src/protocol/edit_protocol';

const op = (text: string): {do: string; off: boolean; text: string} =>
  ({do: text.split(' ')[0], off: false, text});
const list = (texts: string): ReturnType<typeof op>[] => texts ? texts.split(', ').map(op) : [];
const origins = (before: string, after: string): number[] => originsOf(list(before), list(after));

test('the origins of operations are computed from a patch', () => {
  const cases: [OpStep[], number[]][] = [
    [[{insert: 1, op: {do: 'x'}}], [0, -1, 1, 2, 3]],
    [[{remove: 0}], [1, 2, 3]],
    [[{move: 0, to: 2}], [1, 2, 0, 3]],
    [[{move: 3, to: 0}], [3, 0, 1, 2]],
    [[{replace: 1, op: {do: 'x'}}, {toggle: 2, off: true}], [0, 1, 2, 3]],
    [[{insert: 0, op: {do: 'x'}}, {remove: 1}, {move: 0, to: 3}], [1, 2, 3, -1]],
  ];
  for (const [steps, wanted] of cases) assert.deepEqual(originsOfPatch(4, steps), wanted);
});

test('without a patch, equal operations are found again', () => {
  assert.deepEqual(origins('a, b, c', 'a, b, c'), [0, 1, 2]);
  assert.deepEqual(origins('a, b, c', 'x, a, b, c'), [-1, 0, 1, 2]);
  assert.deepEqual(origins('a, b, c', 'a, c'), [0, 2]);
  assert.deepEqual(origins('a, b, c', 'a, b, x, c'), [0, 1, -1, 2]);
  assert.deepEqual(origins('a, b, c, d', 'a, d, b, c'), [0, 3, 1, 2]);
  assert.deepEqual(origins('', 'a, b'), [-1, -1]);
  assert.deepEqual(origins('a, b', ''), []);
});

test('a changed operation is still the same one', () => {
  assert.deepEqual(origins('a, b 1, c', 'a, b 2, c'), [0, 1, 2]);
  assert.deepEqual(origins('a, b 1, c', 'x, a, b 2, c'), [-1, 0, 1, 2]);
  assert.deepEqual(origins('b 1, b 2, b 3', 'b 1, b 4, b 3'), [0, 1, 2]);
  assert.deepEqual(origins('a, b 1', 'a, c 1'), [0, -1]);
});

test('every operation is the origin of one at most', () => {
  let seed = 7;
  const random = (below: number): number => {
    seed = seed * 1103515245 + 12345 & 0x7fffffff;
    return seed % below;
  };
  const any = (): string => Array.from({length: random(9)}, () =>
    `${'abc'[random(3)]} ${random(3)}`).join(', ');
  for (let i = 0; i < 500; ++i) {
    const [before, after] = [any(), any()];
    const found = origins(before, after).filter((one) => one >= 0);
    assert.equal(new Set(found).size, found.length, `${before} -> ${after}`);
    const [old, now] = [list(before), list(after)];
    originsOf(old, now).forEach((one, j) => {
      if (one >= 0) assert.equal(old[one].do, now[j].do);
    });
  }
});

test('a drop between rows becomes a move', () => {
  assert.equal(moveTarget(0, 3), 2);
  assert.equal(moveTarget(3, 1), 1);
  assert.equal(moveTarget(2, 2), null);
  assert.equal(moveTarget(2, 3), null);
  for (let from = 0; from < 4; ++from) {
    for (let before = 0; before <= 4; ++before) {
      const to = moveTarget(from, before);
      if (to === null) continue;
      const moved = originsOfPatch(4, [{move: from, to}]);
      // The row is now before the one that it was dropped on.
      assert.equal(moved[moved.indexOf(from) + 1], before === 4 ? undefined : before);
    }
  }
});

test('the place of a drop is found from the middles of the rows', () => {
  const middle = (i: number): number => 10 + 20 * i;
  assert.equal(rowsAbove(5, middle, -100), 0);
  assert.equal(rowsAbove(5, middle, 31), 2);
  assert.equal(rowsAbove(5, middle, 1000), 5);
  assert.equal(rowsAbove(0, middle, 1000), 0);
});

test('instants are the same until an operation changes time', () => {
  const ops = list('filter@1, cut@1, plant@1, retime@1').map((one, i) => ({...one, off: i === 3}));
  assert.equal(haveSameTimes(ops, 0, 1), true);
  assert.equal(haveSameTimes(ops, 0, 2), false);
  assert.equal(haveSameTimes(ops, 2, 0), false);
  assert.equal(haveSameTimes(ops, 2, 4), true);
  assert.equal(haveSameTimes(ops, 1, 1), true);
});
