// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The search space of a push, and jumps in the recipe.

import assert from 'node:assert/strict';
import test from 'node:test';
import {rangeWithMargin} from '../src/edit_scene/jump_curves';
import {
  clampToSpace, fallsUnusually, heightsAt, islandsOf, jumpWords, lowestChange, lowestWords,
  peakOf, planWords, showsTimesAfter,
  shownJump,
} from '../src/edit_scene/jump_search';
import type {FoundJumpWords, OpKeys, OpWords, SpaceColumnWords} from
  '../src/protocol/edit_protocol';
import {columnAt, madeJump, madeSpace, thesisPush} from './made_jump';

const op = (keys: OpKeys, off = false): OpWords =>
  ({do: keys.do, off, text: JSON.stringify(keys), keys});

const space = madeSpace();

/** Reproducible numbers from 0 to 1. */
function numbers(seed: number): () => number {
  let state = seed;
  return () => {
    state = (state * 1664525 + 1013904223) % 2 ** 32;
    return state / 2 ** 32;
  };
}

test('the made space is that of the thesis: a triangle from 44 to 78 % of the push', () => {
  assert.ok(Math.abs(space[0][0] - 0.44) < 0.011);
  assert.ok(Math.abs(space[space.length - 1][0] - 0.78) < 0.011);
  // Heights above the start of 1 m: table of the design.
  const [, low, high, , highRule] = columnAt(0.54)!;
  assert.ok(Math.abs(low - 0.79) < 0.002 && Math.abs(high - 0.84) < 0.002);
  assert.equal(highRule, 'rise');
  assert.equal(islandsOf(space).length, 1);
});

test('a clamped point is in the space, and a point in it is only rounded', () => {
  const next = numbers(7);
  for (let i = 0; i < 500; ++i) {
    const wanted = {at: 1.4 * next() - 0.2, height_m: 0.4 + 0.8 * next()};
    const made = clampToSpace(space, wanted)!;
    const [low, high] = heightsAt(space, made.at);
    assert.ok(made.at >= space[0][0] && made.at <= space[space.length - 1][0]);
    assert.ok(made.height_m >= low - 1e-9 && made.height_m <= high + 1e-9);
    assert.deepEqual(clampToSpace(space, made), made, 'clamping twice is clamping once');
    if (wanted.at < space[0][0] || wanted.at > space[space.length - 1][0]) continue;
    assert.ok(Math.abs(made.at - wanted.at) <= 0.5e-3 + 1e-9);
    if (wanted.height_m < low - 1e-3) assert.ok(made.height_m - low < 1.01e-4);
    if (wanted.height_m > high + 1e-3) assert.ok(high - made.height_m < 1.01e-4);
  }
});

test('the push of a clamped point is never negative beyond the width of a column', () => {
  const next = numbers(11);
  for (let i = 0; i < 200; ++i) {
    const {at, height_m} = clampToSpace(space, {at: next(), height_m: 0.4 + 0.8 * next()})!;
    const push = thesisPush(at, height_m);
    let least = Infinity;
    for (let k = 1; k < 240; ++k) least = Math.min(least, push(k / 240)[2] + 9.81);
    assert.ok(least > -0.5, `${at} ${height_m} ${least}`);
  }
});

test('a point between two parts of a space is moved to the nearer one', () => {
  const column = (at: number): SpaceColumnWords => [at, 0.5, 0.9, 'force', 'fall'];
  const parts = [0.1, 0.2, 0.3, 0.6, 0.7].map(column);
  assert.deepEqual(islandsOf(parts).map((one) => one.length), [3, 2]);
  assert.deepEqual(clampToSpace(parts, {at: 0.4, height_m: 0.7}), {at: 0.3, height_m: 0.7});
  assert.deepEqual(clampToSpace(parts, {at: 0.5, height_m: 2}), {at: 0.6, height_m: 0.9});
  assert.deepEqual(clampToSpace(parts, {at: 0.65, height_m: 0}), {at: 0.65, height_m: 0.5});
  assert.equal(clampToSpace([], {at: 0.5, height_m: 1}), null);
  // A single column, and one that is thinner than the rounding.
  assert.deepEqual(clampToSpace([column(0.45)], {at: 0, height_m: 0}), {at: 0.45, height_m: 0.5});
  const thin = clampToSpace([[0.5, 0.70002, 0.70004, 'force', 'fall']], {at: 0.5, height_m: 1})!;
  assert.ok(thin.height_m >= 0.70002 && thin.height_m <= 0.70004);
});

test('the words of a point name its range, and the rule at an edge', () => {
  assert.match(lowestWords(space, {at: 0.6, height_m: 0.75}), /60 % .* possible: 0\.6\d+ to 0\.8/);
  const [at, low, high, lowRule, highRule] = space[10];
  assert.equal(lowRule, 'force');
  assert.match(lowestWords(space, {at, height_m: low}), /deeper, the push would be negative/);
  assert.equal(highRule, 'rise');
  assert.match(lowestWords(space, {at, height_m: high}), /higher, the body would sink after P2/);
  assert.match(lowestWords(space, {at: 0.1, height_m: 1}), /m high\.$/);
});

test('the shown jump is the selected one, or the one that made the shown motion', () => {
  const ops = [op({do: 'jump@1', jump: 2}), op({do: 'filter@1'}), op({do: 'jump@1'}),
    op({do: 'tag@1', text: 'a'}), op({do: 'retarget@1', avatar: 'a.vrm'})];
  assert.equal(shownJump(ops, 0, null), 0);
  assert.equal(shownJump(ops, 1, null), 2, 'a tag and a retarget change no time');
  assert.equal(shownJump(ops, null, 2), null);
  assert.equal(shownJump(ops, null, 1), 0);
  assert.equal(shownJump([op({do: 'jump@1'}, true)], null, null), null, 'it is off');
  assert.ok(showsTimesAfter(ops, 2, null));
  assert.ok(!showsTimesAfter(ops, 0, null), 'the second jump has other times');
  assert.ok(showsTimesAfter(ops, 0, 2));
  assert.ok(!showsTimesAfter(ops, 0, 0), 'before the jump');
});

test('a dragged lowest point keeps the wishes and sets the law', () => {
  const ops = [op({do: 'cut@1'}), op({do: 'jump@1', apex_by_m: 0.2})];
  const lowest = {at: 0.612, height_m: 0.7031};
  assert.deepEqual(lowestChange(1, lowest)(ops),
    [{replace: 1, op: {do: 'jump@1', apex_by_m: 0.2, law: 'thesis', lowest}}]);
  assert.equal(lowestChange(0, lowest)(ops), null, 'another operation has its place');
  assert.equal(lowestChange(2, lowest)(ops), null);
});

test('a jump in words; a fall far from gravity is unusual', () => {
  const found: FoundJumpWords = {start_s: 0, takeoff_s: 1.304, apex_s: 1.5, landing_s: null,
    end_s: null, airtime_s: null, rise_m: 0.3014, fall_m_s2: -12.2, lowest_at: null, lowest_m: 0.7,
    takeoff: 'measured', landing: 'inferred', findings: []};
  assert.deepEqual(jumpWords(found), ['1.30 s', 'cut off', '30.1 cm', '−12.2 m/s²']);
  assert.deepEqual(jumpWords({...found, airtime_s: 0.496, fall_m_s2: 0}).slice(1),
    ['0.50 s', '30.1 cm', '–']);
  assert.ok(fallsUnusually(found));
  assert.ok(!fallsUnusually({...found, fall_m_s2: -9.5}));
  assert.ok(!fallsUnusually({...found, fall_m_s2: 0}), 'unknown');
  assert.ok(!fallsUnusually(found, 12));
  const curve = {time_s: [0, 1, 2, 3, 4], push_g: [null, 1, 2.5, null, 3]};
  assert.equal(peakOf(curve, 0, 3), 2.5);
  assert.equal(peakOf(curve, 3, 4), 3);
  assert.equal(peakOf(curve, 5, 6), null);
  const made = madeJump('1', 0, {do: 'jump@1', apex_by_m: 0.1});
  assert.match(planWords(made),
    /^Push 0\.70.s with up to 2\.\d.g, 0\.5\d.s in the air, landing 0\.50.s with up to 2\.\d.g\.$/);
  assert.equal(planWords({...made, phases: null}), '');
  assert.deepEqual(rangeWithMargin([null, 1, 2], 0.1), [0.9, 2.1]);
  assert.deepEqual(rangeWithMargin([null]), [0, 1]);
});
