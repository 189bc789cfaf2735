// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Values of operations: changes, rules between keys, new operations, summaries.

import assert from 'node:assert/strict';
import test from 'node:test';
import {constraintFields, constraintOfType, CONSTRAINT_TYPES} from
  '../src/ops/constraint_schema';
import {newConstraint, newOp, newRow, shownOf, whyNot} from '../src/ops/new_op';
import type {Shown} from '../src/ops/new_op';
import type {RowsField} from '../src/ops/op_fields';
import {changedOp, checkOp, completed} from '../src/ops/op_rules';
import {OPS, schemaOf} from '../src/ops/op_schema';
import {figuresOf, figureWords, summaryOf} from '../src/ops/op_summary';
import {instantChanges, quaternionOf, rotationOf} from '../src/ops/op_values';
import type {Changes, Problems} from '../src/ops/op_values';
import type {OpKeys, OutputWords} from '../src/protocol/edit_protocol';

const set = (op: OpKeys, changes: Changes): OpKeys => changedOp(op, completed(op, changes));
const wrong = (op: OpKeys): Record<string, string> => Object.fromEntries(checkOp(op) as Problems);

const output = {frames: 361, rate_hz: 120, annotations: [
  {text: 'phase', start_s: 0, end_s: 1}, {text: 'phase', start_s: 2, end_s: 2.5}],
contacts: [
  {name: 'left heel', foot: 'left', part: 'heel', spans: [[0, 40], [100, 150]]},
  {name: 'left ball', foot: 'left', part: 'ball', spans: [[5, 50], [110, 170], [300, 360]]},
  {name: 'right heel', foot: 'right', part: 'heel', spans: [[60, 110]]},
]} as unknown as OutputWords;
const recipe = {sources: ['', 'stop'].map((id) => ({id, file: '', frames: 1, rate_hz: 1})),
  avatars: ['robot.vrm']};
const shown = shownOf(output, 100.4, recipe);

test('a value that the absence of its key means is removed', () => {
  assert.deepEqual(set({do: 'splice@1', source: 'a', align: false}, {align: true}),
    {do: 'splice@1', source: 'a'});
  assert.deepEqual(set({do: 'splice@1', source: 'a'}, {overlap_s: 0.3}),
    {do: 'splice@1', source: 'a', overlap_s: 0.3});
  assert.deepEqual(set({do: 'level@1', tilt: false}, {tilt: true}), {do: 'level@1'});
  assert.deepEqual(set({do: 'filter@1'}, {blend_s: 0, why: ''}), {do: 'filter@1'});
  assert.deepEqual(set({do: 'contacts@1', detect: true, edits: [{do: 'set'}]}, {edits: []}),
    {do: 'contacts@1', detect: true});
  // Required keys stay, also if they are empty: the form marks them.
  assert.deepEqual(set({do: 'tag@1', text: 'a'}, {text: ''}), {do: 'tag@1', text: ''});
});

test('an instant has one of its three keys', () => {
  const op = {do: 'cut@1', from_s: 1};
  assert.deepEqual(set(op, instantChanges('from', {kind: 'frame', value: 12})),
    {do: 'cut@1', from_frame: 12});
  assert.deepEqual(set(op, instantChanges('from', {kind: 'note', value: 'left.strike[2]'})),
    {do: 'cut@1', from: 'left.strike[2]'});
  assert.deepEqual(set(op, instantChanges('from', null)), {do: 'cut@1'});
});

test('a change removes excluded keys and adds needed keys', () => {
  const retime = {do: 'retime@1', duration_s: 2, rate_hz: 60};
  assert.deepEqual(set(retime, {speed: 2}), {do: 'retime@1', rate_hz: 60, speed: 2});
  const points_xz_m = [[0, 0], [0, 1]];
  assert.deepEqual(set({do: 'path@1', turn_deg: 90, straight: true}, {points_xz_m}),
    {do: 'path@1', points_xz_m});
  assert.deepEqual(set({do: 'path@1', points_xz_m}, {length: 1.2}),
    {do: 'path@1', length: 1.2});
  const low_pass = set({do: 'filter@1', order: 3}, {method: 'butterworth'});
  assert.deepEqual(low_pass, {do: 'filter@1', method: 'butterworth'});
  const given = set(low_pass, {cutoff: 'given'});
  assert.deepEqual(wrong(given), {});
  assert.equal(typeof given.cutoff_hz, 'number');
  assert.deepEqual(set(low_pass, {cutoff_hz: 8}),
    {do: 'filter@1', method: 'butterworth', cutoff: 'given', cutoff_hz: 8});
  assert.deepEqual(set(given, {cutoff: 'yu'}),
    {do: 'filter@1', method: 'butterworth', cutoff: 'yu'});
  assert.deepEqual(set(given, {method: 'gcv'}), {do: 'filter@1'});
  const faded = set({do: 'splice@1', source: 'a'}, {blend_s: 0.2});
  assert.deepEqual(faded, {do: 'splice@1', source: 'a', overlap_s: 0, blend_s: 0.2});
  assert.deepEqual(set(faded, {overlap_s: 0.1}), {do: 'splice@1', source: 'a', overlap_s: 0.1});
});

test('wishes of a jump exclude each other, and a lowest point has the law that uses it', () => {
  const jump = {do: 'jump@1', apex_by_m: 0.1};
  assert.deepEqual(set(jump, {apex_m: 1.5}), {do: 'jump@1', apex_m: 1.5});
  assert.deepEqual(set({do: 'jump@1', length_m: 1, box_m: 0.3}, {land_m: [0, 0.3, 1]}),
    {do: 'jump@1', land_m: [0, 0.3, 1]});
  assert.deepEqual(set({do: 'jump@1', land_m: [0, 0.3, 1], airtime_s: 0.5}, {box_m: 0.2}),
    {do: 'jump@1', airtime_s: 0.5, box_m: 0.2});
  const low = set(jump, {lowest: {at: 0.6, height_m: 0.7}});
  assert.deepEqual(low, {...jump, law: 'thesis', lowest: {at: 0.6, height_m: 0.7}});
  assert.deepEqual(wrong(low), {});
  assert.deepEqual(set(low, {law: 'force'}), jump);
  assert.deepEqual(set(low, {law: 'thesis'}), low);
  assert.equal(summaryOf(low), 'higher by 0.1\u00a0m; thesis; lowest point share of the push ' +
    '0.6, height 0.7\u00a0m');
});

test('a constraint and a detection exclude each other', () => {
  const touches = set({do: 'constrain@1', adapt: true}, {detect: 'touches'});
  assert.deepEqual(wrong(touches), {});
  const supports = set(touches, {detect: 'supports'});
  assert.deepEqual(supports, {do: 'constrain@1', adapt: true, detect: 'supports'});
  const own = set({...supports, from_s: 1}, {constraint: newConstraint()});
  assert.deepEqual(wrong(own), {});
  assert.ok(!('detect' in own) && own.from_s === 1);
  assert.deepEqual(set({...own, blend_s: 0.1}, {constraint: undefined}),
    {do: 'constrain@1', adapt: true});
});

test('a constraint of another type has the keys of that type', () => {
  for (const type of CONSTRAINT_TYPES) {
    const made = constraintOfType({...newConstraint(), start_s: 1}, type);
    const keys = constraintFields(type).flatMap(({key}) => [key, `${key}_s`, `${key}_deg`]);
    for (const key of Object.keys(made)) assert.ok(keys.includes(key), `${type}: ${key}`);
    assert.equal(made.start_s, 1);
    const missing = wrong({do: 'constrain@1', constraint: made});
    // Only the user knows the name of another constraint.
    assert.deepEqual(Object.keys(missing), type === 'ConstraintDistance'
      ? ['constraint.other_constraint'] : [], type);
  }
});

test('mistakes are found at their keys', () => {
  const cases: [OpKeys, string][] = [
    [{do: 'cut@1', from_s: 2, to_s: 1}, 'to'],
    [{do: 'cut@1', from_s: -1}, 'from'],
    [{do: 'jump@1', apex_m: 1, apex_by_m: 0.1}, 'apex_m'],
    [{do: 'jump@1', land_m: [0, 0, 1], box_m: 0.1}, 'land_m'],
    [{do: 'jump@1', lowest: {at: 0.6, height_m: 0.7}}, 'lowest'],
    [{do: 'jump@1', law: 'thesis', lowest: {at: 1, height_m: 0.7}}, 'lowest.at'],
    [{do: 'jump@1', law: 'thesis', lowest: {at: 0.5}}, 'lowest.height_m'],
    [{do: 'jump@1', law: 'thesis', lowest: 0.7}, 'lowest'],
    [{do: 'jump@1', gravity_m_s2: 31}, 'gravity_m_s2'],
    [{do: 'keep@1', spans: [{from_s: 2, to_s: 1}]}, 'spans.0.to'],
    [{do: 'split@1', instants: []}, 'instants'],
    [{do: 'split@1', instants: [{at_s: 1}, {at_s: 1}]}, 'instants.1.at'],
    [{do: 'retime@1'}, ''],
    [{do: 'retime@1', knots: [{at_s: 0, time_s: 1}, {at_s: 1, time_s: 1}]}, 'knots.1.time_s'],
    [{do: 'filter@1', method: 'butterworth', cutoff: 'given'}, 'cutoff_hz'],
    [{do: 'filter@1', order: 4}, 'order'],
    [{do: 'exaggerate@1', low_hz: 2, high_hz: 1}, 'high_hz'],
    [{do: 'pose@1', at_s: 1, bone: 'hips'}, ''],
    [{do: 'pose@1', at_s: 1, bone: 'hip', moved_m: [0, 0, 0]}, 'bone'],
    [{do: 'pose@1', bone: 'hips', moved_m: [0, 0, 0]}, 'at'],
    [{do: 'offset@1', bone: 'hips', rotation_deg: [0, 400, 0]}, 'rotation'],
    [{do: 'offset@1', bone: 'hips', rotation_wxyz: [1, 1, 0, 0]}, 'rotation'],
    [{do: 'place@1', at_s: 1}, ''],
    [{do: 'path@1', points_xz_m: [[0, 0]]}, 'points_xz_m'],
    [{do: 'path@1', points_xz_m: [[0, 0], [0, 0.001]]}, 'points_xz_m.1'],
    [{do: 'cyclify@1', min_period_s: 2, max_period_s: 1}, 'max_period_s'],
    [{do: 'cyclify@1', cycles: 1.5}, 'cycles'],
    [{do: 'contacts@1'}, ''],
    [{do: 'contacts@1', edits: [{do: 'set', foot: 'left', part: 'heel', from_s: 2, to_s: 1}]},
      'edits.0.to_s'],
    [{do: 'constrain@1', detect: 'touches'}, 'objects'],
    [{do: 'event@1', text: 'a\nb', at_s: 0}, 'text'],
    [{do: 'event@1', text: 'a', at: ''}, 'at'],
    [{do: 'curve@1', name: 'w', keys: []}, 'keys'],
    [{do: 'scale_time@1', speed: 0}, 'speed'],
    [{do: 'tag@1', text: 'x'.repeat(1001)}, 'text'],
  ];
  for (const [op, path] of cases) {
    assert.deepEqual(Object.keys(wrong(op)), [path], JSON.stringify(op));
  }
  // Instants of different kinds cannot be compared here.
  assert.deepEqual(wrong({do: 'cut@1', from_s: 2, to: 'left.strike'}), {});
  assert.deepEqual(wrong({do: 'contacts@1', edits: [
    {do: 'move_end', foot: 'left', part: 'heel', from_s: 2, to_s: 1.9}]}), {});
});

test('a cycle has both ends or none', () => {
  assert.deepEqual([...checkOp({do: 'cyclify@1', cycle_from_s: 1}).keys()], ['cycle_to']);
  assert.deepEqual([...checkOp({do: 'cyclify@1', cycle_to: 'left.strike'}).keys()],
    ['cycle_from']);
  assert.equal(checkOp({do: 'cyclify@1', cycle_from_frame: 3, cycle_to_s: 1}).size, 0);
});

test('new operations are valid at once', () => {
  const empty = {...shown, duration_s: 0, now_s: 0};
  for (const {name} of OPS) {
    assert.equal(whyNot(name, shown, []), '');
    assert.deepEqual(wrong(newOp(name, shown)), {}, name);
    assert.deepEqual(wrong(newOp(name, empty)), {}, name);
  }
  assert.deepEqual(newOp('cut', shown), {do: 'cut@1', from_s: 0, to_s: 3});
  assert.deepEqual(newOp('event', shown), {do: 'event@1', text: 'event', at_s: 0.837});
  assert.deepEqual(newOp('retime', shown), {do: 'retime@1', duration_s: 3});
  assert.match(whyNot('splice', {...shown, sources: []}, []), /second source/);
  assert.match(whyNot('retarget', shown, [{do: 'retarget@1'}]), /retarget/);
});

test('times of new operations do not exceed the motion', () => {
  // 100 frames at 119.88 Hz last 0.82582… s, which is less than its rounded value.
  const rate_hz = 119.88;
  const duration_s = 99 / rate_hz;
  const odd = shownOf({...output, frames: 100, rate_hz}, 99, recipe);
  assert.ok(Number(newOp('cut', odd).to_s) <= duration_s);
  assert.ok(duration_s - Number(newOp('cut', odd).to_s) < 0.001);
  assert.ok(odd.now_s <= duration_s);
});

test('new rows follow the others', () => {
  const field = (op: string, key: string): RowsField =>
    schemaOf({do: op}).fields.find((one) => one.key === key) as RowsField;
  for (const [op, key] of [['split', 'instants'], ['retime', 'knots'], ['curve', 'keys'],
    ['keep', 'spans'], ['contacts', 'edits'], ['constrain', 'objects']]) {
    const rows: Changes[] = [];
    const at: Shown = {...shown, now_s: 2.95};
    for (let i = 0; i < 4; ++i) rows.push(newRow(field(op, key), rows as never, at));
    const extra: Changes = op === 'constrain' ? {detect: 'touches'} : {};
    assert.deepEqual(wrong(set(newOp(op, at), {...extra, [key]: rows as never})), {}, op);
  }
});

test('names of instants are numbered like those of recipes', () => {
  // A stance at the start or the end of the motion has no event there.
  assert.deepEqual(shown.names, ['phase', 'phase[1]', 'left.toe_off', 'left.strike',
    'left.toe_off[1]', 'left.strike[1]', 'right.strike', 'right.toe_off']);
});

test('rotations convert both ways', () => {
  assert.deepEqual(quaternionOf([0, 90, 0]), [0.707107, 0, 0.707107, 0]);
  assert.deepEqual(rotationOf([0.707107, 0, 0.707107, 0]), [0, 90, 0]);
  assert.deepEqual(rotationOf([-0.707107, 0, -0.707107, 0]), [0, 90, 0]);
  assert.deepEqual(rotationOf([1, 0, 0, 0]), [0, 0, 0]);
  for (const v of [[10, -20, 30], [0, 0, 179], [-120, 40, 1]]) {
    rotationOf(quaternionOf(v)).forEach((one, i) => assert.ok(Math.abs(one - v[i]) < 0.01));
  }
});

test('summaries name the values that are not defaults', () => {
  assert.equal(summaryOf({do: 'cut@1', from_s: 0.4, to: 'left.strike[2]'}),
    '0.40\u00a0s to left.strike[2]');
  assert.equal(summaryOf({do: 'plant@1'}), '');
  assert.equal(summaryOf({do: 'path@1', turn_deg: -90, straight: true}),
    'turn −90°; remove the turn first');
  assert.equal(summaryOf({do: 'retime@1', knots: [{at_s: 0, time_s: 0}], rate_hz: 60}),
    '1 knot; frame rate 60\u00a0Hz');
  assert.equal(summaryOf({do: 'filter@1', groups: ['left_arm']}), 'left arm');
  assert.equal(summaryOf({do: 'level@1', tilt: false}), 'not: rotate the motion');
  assert.equal(summaryOf({do: 'constrain@1', constraint: {type: 'Distance', name: 'rail',
    segment: 'rightHand', start_s: 1}}), 'Distance “rail” of right hand, from 1.00\u00a0s');
  for (const {name} of OPS) {
    assert.doesNotMatch(summaryOf(newOp(name, shown)), /undefined|NaN/, name);
  }
});

test('figures have the units of their names', () => {
  assert.deepEqual(figureWords('displaced_mm', 12.345), ['displaced', '12.3\u00a0mm']);
  assert.deepEqual(figureWords('turn_rate_deg_per_s', 71.2), ['turn rate', '71.2°/s']);
  assert.deepEqual(figureWords('tilt_deg', -0.5), ['tilt', '−0.50°']);
  assert.deepEqual(figureWords('velocity_gap_m_per_s', 0.123), ['velocity gap', '0.12\u00a0m/s']);
  assert.deepEqual(figureWords('added_acceleration_m_per_s2', 130.4),
    ['added acceleration', '130\u00a0m/s²']);
  assert.deepEqual(figureWords('stances', 7), ['stances', '7']);
  const report = (figures: Record<string, number>): never =>
    ({op: 0, do: 'filter@1', figures, findings: []}) as never;
  assert.deepEqual(figuresOf([report({impacts: 1, displaced_mm: 2}), report({displaced_mm: -3})]),
    [['displaced_mm', -3], ['impacts', 1]]);
});
