// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The badge at the top.

import assert from 'node:assert/strict';
import test from 'node:test';
import {pillOf, STATUS_SILENCE_MS} from '../src/panels/pill';

const good = {subject: 'tracked' as const, warnings: []};

test('the badge is good while the last status is good and recent', () => {
  assert.equal(pillOf(true, true, good, 0).state, 'tracked');
  assert.equal(pillOf(true, true, good, 500).state, 'tracked');
  assert.equal(pillOf(true, true, good, STATUS_SILENCE_MS + 1).state, 'silent');
  assert.match(pillOf(true, true, good, 5000).why, /too busy/);
});

test('the badge shows the reason if it is not good', () => {
  const partly = {subject: 'partly' as const,
    warnings: ['camera left is lost', 'leftFoot has not been seen']};
  assert.deepEqual(pillOf(true, true, partly, 100), {state: 'partly', words: 'tracked in part',
    why: 'camera left is lost\nleftFoot has not been seen'});
  for (const subject of ['behind', 'stopped', 'lost'] as const) {
    assert.equal(pillOf(true, true, {subject, warnings: []}, 0).state, subject);
    assert.doesNotMatch(pillOf(true, true, {subject, warnings: []}, 0).words, /tracked/);
  }
});

test('the badge distinguishes files and lost connections', () => {
  assert.equal(pillOf(false, true, good, 0).state, 'offline');
  assert.equal(pillOf(true, false, null, 9e9).state, 'file');
  assert.equal(pillOf(true, true, null, 9e9).state, 'waiting');
});
