// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

import assert from 'node:assert/strict';
import test from 'node:test';
import {Messages} from '../src/panels/messages';

test('what the server does not say any more is gone, what the page found is not', () => {
  const messages = new Messages();
  assert.deepEqual(messages.shown(), []);
  messages.serve(['the body is found', 'No body fits them']);
  messages.add('the skin cannot be read');
  messages.add('the skin cannot be read');
  assert.deepEqual(messages.shown(),
    ['the skin cannot be read', 'No body fits them', 'the body is found']);
  messages.serve(['the body is found']);
  assert.deepEqual(messages.shown(), ['the skin cannot be read', 'the body is found']);
});

test('of what the page found, the last is kept', () => {
  const messages = new Messages();
  for (let i = 0; i < 20; ++i) messages.add(`trouble ${i}`);
  assert.equal(messages.shown().length, 8);
  assert.equal(messages.shown()[0], 'trouble 19');
});
