// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Messages and texts of a scene that runs live.

import assert from 'node:assert/strict';
import test from 'node:test';
import {pillOf} from '../src/panels/pill';
import {figureText, timeText} from '../src/panels/run_panel';
import {readServerWords} from '../src/protocol/protocol';
import {ConstraintView} from '../src/scene/constraint_view';
import type {ConstraintWords, Vector} from '../src/protocol/protocol';

const target = (id: string, at: Vector): ConstraintWords =>
  ({id, skeleton: 0, kind: 'position', active: false, p_in_world: at, draggable: true});

function targets(): ConstraintView {
  const view = new ConstraintView();
  view.set([target('a', [0, 0, 0]), target('b', [1, 0, 0])], [], null);
  return view;
}

test('values have three significant digits, and a dash before they are measured', () => {
  assert.equal(figureText({value: null, unit: 'mm'}), '–');
  assert.equal(figureText({value: 0.0371, unit: 'mm'}), '0.037 mm');
  assert.equal(figureText({value: 3.456, unit: 'percent'}), '3.46 percent');
  assert.equal(figureText({value: -1234.5, unit: ''}), '-1235');
  assert.equal(timeText({time_s: 12.34, duration_s: 60}), '12.3 of 60.0 s');
  assert.equal(timeText({time_s: 61, duration_s: 60}), '61.0 s, the script ended');
});

test('messages about the run and the targets are accepted', () => {
  assert.equal(readServerWords('{"type":"run"}').type, 'run');
  assert.equal(readServerWords('{"type":"targets"}').type, 'targets');
  assert.equal(readServerWords('{"type":"runs"}').type, 'bad');
});

test('targets move, except a dragged one, whose state still changes', () => {
  const view = targets();
  view.setTargets([[0, 1, 0], [1, 1, 0]], [true, true], 'b');
  assert.deepEqual(view.handles.map(({shown_in_world}) => shown_in_world), [[0, 1, 0], [1, 0, 0]]);
  assert.deepEqual(view.handles.map(({words}) => words.active), [true, true]);
});

test('targets of another scene are ignored', () => {
  const view = targets();
  view.setTargets([[0, 1, 0]], [true], null);
  view.setTargets([[0, 1, 0], [1, 1, 0]], [true], null);
  assert.deepEqual(view.handles.map(({words}) => words.p_in_world), [[0, 0, 0], [1, 0, 0]]);
  assert.ok(view.handles.every(({words}) => !words.active));
});

test('the pill shows the state of the scene', () => {
  assert.equal(pillOf(true, false, null, 0, 'playing').words, 'scene runs');
  assert.equal(pillOf(true, false, null, 0, 'paused').words, 'scene is paused');
  assert.equal(pillOf(false, false, null, 0, 'playing').state, 'offline');
});
