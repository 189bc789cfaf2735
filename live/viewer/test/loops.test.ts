// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The map of loops, and loops in the recipe.

import assert from 'node:assert/strict';
import test from 'node:test';
import {
  cellOfCycle, cyclifyAt, cycleOfCell, distanceAt, loopChange, loopsUntil, motionKey,
  nearestMinimum, scaleEnd_mm, tickStep,
} from '../src/edit_scene/loop_search';
import type {LoopCandidateWords, LoopMapWords, OpKeys, OpWords} from
  '../src/protocol/edit_protocol';

const op = (keys: OpKeys, off = false): OpWords =>
  ({do: keys.do, off, text: JSON.stringify(keys), keys});

/** A map with the value of `of`, and 0 below the diagonal, as marey sends it. */
const mapOf = (cells: number, of: (row: number, column: number) => number): LoopMapWords =>
  ({cells, cell_frames: 4, distance_mm: Array.from({length: cells * cells}, (_, i) => {
    const [row, column] = [Math.floor(i / cells), i % cells];
    return column < row ? 0 : of(row, column);
  })});

/** Valleys at (2, 12) and (6, 12); it rises away from the diagonal. */
const hills = mapOf(20, (r, c) => (r === c ? 0 : Math.min(
  50 + 10 * (c - r), 10 + 20 * Math.hypot(r - 2, c - 12), 8 + 20 * Math.hypot(r - 6, c - 12))));

test('a click takes the nearest valley in reach', () => {
  assert.deepEqual(nearestMinimum(hills, {row: 3, column: 11}), {row: 2, column: 12});
  assert.deepEqual(nearestMinimum(hills, {row: 6, column: 14}), {row: 6, column: 12});
  // Both are equally near: the lower one.
  assert.deepEqual(nearestMinimum(hills, {row: 4, column: 12}), {row: 6, column: 12});
  assert.equal(nearestMinimum(hills, {row: 2, column: 16}), null, 'out of reach');
});

test('the diagonal and the half below it are no valleys', () => {
  assert.equal(nearestMinimum(hills, {row: 15, column: 16}), null);
  assert.equal(distanceAt(hills, 5, 4), Infinity);
  assert.equal(distanceAt(hills, -1, 4), Infinity);
  assert.equal(distanceAt(hills, 4, 20), Infinity);
  const flat = mapOf(9, () => 7);
  assert.equal(nearestMinimum(flat, {row: 3, column: 5}, 1), null, 'a plain has none');
});

test('the map is not searched beyond its edge', () => {
  const edge = mapOf(10, (r, c) => (r === c ? 0 : 20 + (9 - c) + r));
  assert.deepEqual(nearestMinimum(edge, {row: 1, column: 8}), {row: 0, column: 9});
});

test('a cell gives the frames of a candidate in it, otherwise its own', () => {
  const candidate: LoopCandidateWords = {first: 9, last: 50, first_s: 0, last_s: 0,
    period_s: 0, distance_mm: 20, edge: 'none'};
  assert.deepEqual(cycleOfCell(hills, {row: 2, column: 12}, [candidate]), {first: 9, last: 50});
  assert.deepEqual(cycleOfCell(hills, {row: 2, column: 12}, []), {first: 9, last: 49});
  // The last cell may hold one frame only.
  assert.deepEqual(cycleOfCell(hills, {row: 3, column: 19}, []), {first: 12, last: 76});
  assert.deepEqual(cellOfCycle(hills, {first: 9, last: 50}), {row: 2, column: 12});
  assert.deepEqual(cellOfCycle(hills, {first: 9, last: 99}), {row: 2, column: 19});
});

test('the scale ends at a round number that 90 % do not exceed', () => {
  const values = mapOf(40, (_, c) => 5 * c);
  const end = scaleEnd_mm(values);
  const above: number[] = [];
  for (let r = 0; r < 40; ++r) for (let c = r + 1; c < 40; ++c) above.push(5 * c);
  const beyond = above.filter((value) => value > end).length;
  assert.ok(beyond <= 0.1 * above.length);
  assert.equal(end % 50, 0);
  assert.equal(scaleEnd_mm(mapOf(1, () => 0)), 1);
});

test('ticks are 1, 2 or 5 times a power of ten', () => {
  assert.equal(tickStep(6.1, 6), 2);
  assert.equal(tickStep(60, 6), 10);
  assert.equal(tickStep(1.2, 6), 0.2);
  assert.equal(tickStep(0, 6), 1);
});

test('a loop is inserted, and made again with other frames', () => {
  const cut = op({do: 'cut@1', to_s: 3});
  const made = loopChange({first: 12.4, last: 45.5}, null)([cut]);
  assert.deepEqual(made, [{insert: 1,
    op: {do: 'cyclify@1', cycle_from_frame: 12, cycle_to_frame: 46}}]);
  // Its own result is shown, or the motion that it receives.
  const looped = [cut, op({do: 'cyclify@1', min_period_s: 1, drift: 'none', cycle_from_s: 1,
    cycle_to: 'left.strike[2]'}), op({do: 'tag@1', text: 'a'})];
  for (const until of [null, 1]) {
    assert.deepEqual(loopChange({first: 1, last: 30}, until)(looped), [{replace: 1, op: {
      do: 'cyclify@1', drift: 'none', cycle_from_frame: 1, cycle_to_frame: 30}}]);
  }
  // Another operation acts in between.
  const [step] = loopChange({first: 1, last: 30}, null)([...looped, op({do: 'path@1'})])!;
  assert.deepEqual(step, {insert: 4,
    op: {do: 'cyclify@1', cycle_from_frame: 1, cycle_to_frame: 30}});
});

test('loops are searched in the motion that the loop is made of', () => {
  const ops = [op({do: 'cut@1'}), op({do: 'cyclify@1'}), op({do: 'event@1'})];
  assert.equal(loopsUntil(ops, null), 1);
  assert.equal(loopsUntil(ops, 1), 1);
  assert.equal(loopsUntil(ops.slice(0, 1), null), 1);
  assert.equal(loopsUntil([op({do: 'retarget@1'})], null), 0);
  assert.equal(loopsUntil([ops[0], op({do: 'cyclify@1'}, true)], null), 2);
  assert.equal(cyclifyAt(ops, 1), 1);
  assert.equal(cyclifyAt(ops, 0), null);
});

test('results stay valid while their motion does', () => {
  const cut = op({do: 'cut@1', to_s: 3});
  const key = motionKey([cut], 1);
  const looped = [cut, op({do: 'cyclify@1'})];
  assert.equal(motionKey(looped, loopsUntil(looped, null)), key);
  const noted = [op({do: 'tag@1', text: 'x'}), cut, op({do: 'filter@1'}, true)];
  assert.equal(motionKey(noted, loopsUntil(noted, null)), key);
  const other = [op({do: 'cut@1', to_s: 2})];
  assert.notEqual(motionKey(other, 1), key);
  const turned = [...looped, op({do: 'path@1', turn_deg: 90})];
  assert.notEqual(motionKey(turned, loopsUntil(turned, null)), key);
});
