// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

import assert from 'node:assert/strict';
import test from 'node:test';
import {clipOf, histogram} from '../src/report/library_data';
import type {CheckSummary} from '../src/report/library_data';

test('a histogram has its limits inside, and counts values above apart', () => {
  const {counts, from, to, above} = histogram([0, 1, 2, 9.9, 12.5, 13], [5, 10], 10);
  assert.equal(from, 0);
  assert.equal(to, 12.5);
  assert.equal(above, 1);
  assert.equal(counts.reduce((sum, count) => sum + count, 0), 5);
  assert.equal(counts[9], 1);
});

test('a histogram without limits holds all values, negative ones too', () => {
  const {counts, from, above} = histogram([-4, -2, 1], null, 5);
  assert.equal(from, -4);
  assert.equal(above, 0);
  assert.deepEqual(counts, [1, 0, 1, 0, 1]);
  assert.deepEqual(histogram([], null, 3).counts, [0, 0, 0]);
  assert.deepEqual(histogram([0, 0], null, 2).counts, [2, 0]);
});

test('frames of a clip become seconds', () => {
  const summary = {kinds: [{kind: 'Spike'}]} as unknown as CheckSummary;
  const clip = clipOf(['id1', 'Walk', 'a.bvh', 2, 60, 30, [1, null], '2-',
    [[0, 'head', 15, 20]], [[0, 'head', 15, 29, 7, 2]]], summary, 4);
  assert.equal(clip.seconds, 2);
  assert.deepEqual(clip.verdicts, [2, null]);
  assert.equal(clip.places.get(0)?.start_s, 0.5);
  assert.equal(clip.problems[0].end_s, 1);
  assert.equal(clip.rank, 4);
  assert.ok(clip.words.includes('walk') && clip.words.includes('spike'));
});
