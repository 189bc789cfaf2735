// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

import assert from 'node:assert/strict';
import test from 'node:test';
import {Messages} from '../src/panels/messages';

test('messages that the server no longer sends disappear, those of the page stay', () => {
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

test('the last message of the page is kept', () => {
  const messages = new Messages();
  for (let i = 0; i < 20; ++i) messages.add(`trouble ${i}`);
  assert.equal(messages.shown().length, 8);
  assert.equal(messages.shown()[0], 'trouble 19');
});
