// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Tools of the edit page in the scene: paths on the floor, changes of the recipe.

import assert from 'node:assert/strict';
import test from 'node:test';
import type {Change} from '../src/edit/edit_document';
import {opToChange} from '../src/edit_scene/op_to_change';
import {pathOpWithPoints, pointsChange, pointsOf, shapeChange, shownShape} from
  '../src/edit_scene/path_changes';
import {legLength_m} from '../src/edit_scene/leg_length';
import {constraintChange, isActiveAt, newConstraint, newConstraintName, poseChange} from
  '../src/edit_scene/pose_changes';
import type {EditConstraintWords, OpKeys, OpStep, OpWords} from '../src/protocol/edit_protocol';
import type {SceneFrame} from '../src/protocol/decode_frame';
import type {JointWords, SkeletonWords, Vector} from '../src/protocol/protocol';
import {
  curveThrough, equidistant, hipsPath, nearestOnPath, placeAt, pointCount, reachOf, smoothed,
  waysOf,
} from '../src/scene/floor_path';

const op = (keys: OpKeys, off = false): OpWords => ({do: keys.do, off, text: '', keys});
const close = (a: ArrayLike<number>, b: ArrayLike<number>, within = 1e-9): void => {
  assert.equal(a.length, b.length);
  for (let i = 0; i < a.length; ++i) {
    assert.ok(Math.abs(a[i] - b[i]) <= within, `${Array.from(a)} is not ${Array.from(b)}`);
  }
};
const steps = (change: Change | null, ops: OpWords[]): OpStep[] | null => change!(ops);
const at = (frame: number, until: number | null = null) =>
  ({frame, until, rate_hz: 100, frames: 301});

// --- Paths ---

const joint = (bone: string, parent: number, p: Vector): JointWords =>
  ({name: bone, parent, bone, rest: {p, q: [0, 0, 0, 1]}});
const body = (joints: JointWords[]): SkeletonWords =>
  ({name: 'b', kind: 'motion', joints, skin: null, offset_m: [0, 0, 0], estimate: false});
const walk = (frames: number) => ({frames, read(i: number, into: SceneFrame): void {
  into.skeletons[1].hasPose = true;
  into.skeletons[1].root_in_world.set([0.01 * i, 1, 0.02 * i]);
}});

test('the path of the hips contains the first and the last frame', () => {
  const hips = body([joint('hips', -1, [0, 0, 0])]);
  const path = hipsPath(walk(100), [hips, hips], 1, 120);
  assert.equal(path.every, 8);
  close(path.xz.slice(0, 2), [0, 0]);
  close(path.xz.slice(-2), [0.99, 1.98], 1e-6);
  // Hips that are not the root.
  const rooted = body([joint('', -1, [0, 0, 0]), joint('hips', 0, [0.5, 0.9, 0])]);
  close(hipsPath(walk(100), [rooted, rooted], 1, 120).xz.slice(-2), [1.49, 1.98], 1e-6);
  const one = hipsPath(walk(1), [hips, hips], 1, 120);
  close(one.xz, [0, 0]);
});

test('the place at a frame is interpolated, also in the shorter last step', () => {
  const path = hipsPath(walk(12), [body([joint('hips', -1, [0, 0, 0])]),
    body([joint('hips', -1, [0, 0, 0])])], 1, 120);
  const place = [0, 0];
  for (const frame of [0, 3, 8, 9.5, 11]) {
    placeAt(path, frame, place);
    close(place, [0.01 * frame, 0.02 * frame], 1e-6);
  }
  placeAt(path, 99, place);
  close(place, [0.11, 0.22], 1e-6);
});

test('smoothing removes sway and keeps a straight line with its ends', () => {
  const line = Array.from({length: 40}, (_, i) => [0.1 * i, -0.2 * i]).flat();
  close(smoothed(line, 7), line, 1e-12);
  const sway = Array.from({length: 61}, (_, i) => [0.05 * Math.sin(2 * Math.PI * i / 15), i]);
  const smooth = smoothed(sway.flat(), 7);
  for (let i = 7; i < 54; ++i) assert.ok(Math.abs(smooth[2 * i]) < 1e-9);
});

test('points are at equal distances along the path', () => {
  // Uneven steps along an L of 2 m and 1 m.
  const xz = [0, 0, 0.3, 0, 2, 0, 2, 0.9, 2, 1];
  close(waysOf(xz), [0, 0.3, 2, 2.9, 3]);
  close(equidistant(xz, 4).flat(), [0, 0, 1, 0, 2, 0, 2, 1]);
  close(equidistant([1, 1, 1, 1], 3).flat(), [1, 1, 1, 1, 1, 1]);
  assert.equal(reachOf([0, 0, 3, 4, 0, 1]), 5);
  assert.deepEqual([0, 1, 4.2, 5, 40].map(pointCount), [4, 4, 5, 6, 8]);
});

test('the nearest point lies on the path', () => {
  const xz = [0, 0, 2, 0, 2, 2];
  const near = nearestOnPath(xz, 1, 0.5)!;
  close([near.segment, near.x, near.z, near.away_m], [0, 1, 0, 0.5]);
  const corner = nearestOnPath(xz, 3, -1)!;
  close([corner.x, corner.z, corner.away_m], [2, 0, Math.SQRT2]);
  assert.equal(nearestOnPath(xz, 2.1, 1.5)!.segment, 1);
  assert.equal(nearestOnPath([1, 1], 0, 0), null);
});

test('the curve is the natural spline through its points', () => {
  const points: [number, number][] = [[0, 0], [1, 0.5], [2, -0.5], [3.5, 0]];
  const curve = curveThrough(points, 32);
  points.forEach((point, i) => close(curve.slice(64 * i, 64 * i + 2), point, 1e-12));
  // Evenly spaced chords: its bend is 0 at both ends, and its slopes meet at the points.
  const even = curveThrough([[0, 0], [3, 4], [6, 0], [9, 4]], 100);
  const z = (i: number): number => even[2 * i + 1];
  const bend = (i: number): number => z(i - 1) - 2 * z(i) + z(i + 1);
  assert.ok(Math.abs(bend(1)) < 0.03 * Math.abs(bend(100)));
  assert.ok(Math.abs(bend(299)) < 0.03 * Math.abs(bend(200)));
  for (const knot of [100, 200]) {
    const [before, after] = [z(knot) - z(knot - 1), z(knot + 1) - z(knot)];
    assert.ok(Math.abs(after - before) < 0.01, 'slopes meet');
    assert.ok(Math.abs(bend(knot + 1) - bend(knot - 1)) < 1e-4, 'bends meet');
  }
  close(curveThrough([[0, 0], [2, 2]], 2), [0, 0, 1, 1, 2, 2], 1e-12);
  close(curveThrough([[0, 0], [0, 0]], 2), [0, 0]);
});

// --- Changes of the path ---

test('points change the path just before; annotations and switched-off operations between', () => {
  const path = op({do: 'path@1', points_xz_m: [[0, 0], [1, 1]], why: 'corner'});
  const points: [number, number][] = [[0.00049, -0.0001], [2.12345, 1]];
  const ops = [op({do: 'cut@1'}), path, op({do: 'tag@1', text: 'a'}), op({do: 'plant@1'}, true)];
  assert.deepEqual(steps(pointsChange(points, null, null), ops), [{replace: 1, op: {
    do: 'path@1', points_xz_m: [[0, 0], [2.123, 1]], why: 'corner'}}]);
  assert.deepEqual(steps(pointsChange(points, 1, null), ops), [{insert: 1, op: {
    do: 'path@1', points_xz_m: [[0, 0], [2.123, 1]]}}]);
  // Another operation acts after it.
  const later = [...ops, op({do: 'filter@1'})];
  assert.equal(pathOpWithPoints(later, null, null), null);
  assert.equal(pathOpWithPoints(later, null, 1), 1, 'the selected one');
  assert.equal(pathOpWithPoints(later, 1, 1), null, 'not one that is not applied');
  // The points are in the avatar's world, which a retarget has scaled.
  assert.deepEqual(steps(pointsChange([[0, 0], [1, 0]], null, null),
    [op({do: 'retarget@1', avatar: 'a'})]), [{insert: 1, op: {do: 'path@1',
    points_xz_m: [[0, 0], [1, 0]]}}]);
  assert.deepEqual(steps(shapeChange(() => ({length: 1.2}), null),
    [op({do: 'retarget@1', avatar: 'a'})]), [{insert: 0, op: {do: 'path@1', length: 1.2}}]);
  assert.equal(pointsOf({do: 'path@1', points_xz_m: [[0, 0, 1], [1, 1, 1]]}), null);
});

test('turn and length gather in one operation, which goes if it changes nothing', () => {
  const left = shapeChange(({turn_deg}) => ({turn_deg: turn_deg + 90}), null);
  const right = shapeChange(({turn_deg}) => ({turn_deg: turn_deg - 90}), null);
  const longer = shapeChange(() => ({length: 1.2}), null);
  assert.deepEqual(steps(left, []), [{insert: 0, op: {do: 'path@1', turn_deg: 90}}]);
  const turned = [op({do: 'path@1', turn_deg: 90, from_s: 1})];
  assert.deepEqual(steps(longer, turned), [{replace: 0,
    op: {do: 'path@1', from_s: 1, turn_deg: 90, length: 1.2}}]);
  assert.deepEqual(steps(left, turned)![0], {replace: 0,
    op: {do: 'path@1', from_s: 1, turn_deg: 180}});
  assert.deepEqual(steps(right, turned), [{remove: 0}]);
  assert.equal(steps(shapeChange(() => ({length: 1}), null), []), null);
  // Points give the whole path: a turn is another operation.
  const pointed = [op({do: 'path@1', points_xz_m: [[0, 0], [1, 1]]})];
  assert.deepEqual(steps(right, pointed), [{insert: 1, op: {do: 'path@1', turn_deg: -90}}]);
  assert.deepEqual(shownShape(turned, null), {turn_deg: 90, length: 1, straight: false});
});

// --- Poses and constraints ---

test('a drag makes a key, a second one of the same joint and instant adds to it', () => {
  const once = steps(poseChange('leftHand', [0.10049, 0, -0.0002], at(133)), []);
  assert.deepEqual(once, [{insert: 0, op: {do: 'pose@1', at_s: 1.33, bone: 'leftHand',
    moved_m: [0.1, 0, 0], width_s: 0.5}}]);
  const ops = [op({do: 'pose@1', at_s: 1.33, bone: 'leftHand', moved_m: [0.1, 0, 0],
    width_s: 0.8})];
  assert.deepEqual(steps(poseChange('leftHand', [0.1, 0.05, 0], at(133)), ops), [{replace: 0,
    op: {do: 'pose@1', at_s: 1.33, bone: 'leftHand', moved_m: [0.2, 0.05, 0], width_s: 0.8}}]);
  assert.deepEqual(steps(poseChange('leftHand', [-0.1, 0, 0], at(133)), ops), [{remove: 0}]);
  for (const [bone, frame] of [['rightHand', 133], ['leftHand', 134]] as const) {
    assert.ok('insert' in steps(poseChange(bone, [0.1, 0, 0], at(frame)), ops)![0]);
  }
  const byFrame = [op({do: 'pose@1', at_frame: 133.4, bone: 'hips', moved_m: [0, 0.1, 0]})];
  assert.ok('replace' in steps(poseChange('hips', [0, 0.1, 0], at(133)), byFrame)![0]);
  // A key that also turns keeps its turn.
  const turns = [op({do: 'pose@1', at_s: 1.33, bone: 'hips', moved_m: [0, 0.1, 0],
    rotation_deg: [0, 5, 0]})];
  assert.deepEqual(steps(poseChange('hips', [0, -0.1, 0], at(133)), turns), [{replace: 0,
    op: {do: 'pose@1', at_s: 1.33, bone: 'hips', rotation_deg: [0, 5, 0]}}]);
});

const found = (id: string): EditConstraintWords => ({id, kind: 'position',
  segment: 'leftHand', start_s: 1, stop_s: 2, start_duration_s: 0, stop_duration_s: 0,
  p_in_world: [0, 1, 0], draggable: true});

test('a constraint holds a joint around the instant', () => {
  const [step] = steps(newConstraint('leftHand', [0.1, 1.20049, 2], at(150), []), [])!;
  assert.deepEqual(step, {insert: 0, op: {do: 'constrain@1', adapt: true, constraint: {
    type: 'Distance', name: 'left hand 1', segment: 'leftHand', position_m: [0.1, 1.2, 2],
    start_s: 1.25, start_duration_s: 0.2, stop_s: 1.75, stop_duration_s: 0.2}}});
  // No fade at the ends of the motion.
  const edge = (frame: number) => {
    const [made] = steps(newConstraint('hips', [0, 0, 0], at(frame), []), [])!;
    const {type: _type, name: _name, segment: _segment, position_m: _p, ...time} =
      'insert' in made ? made.op.constraint as unknown as Record<string, number> : {};
    return time;
  };
  assert.deepEqual(edge(10), {start_s: 0, stop_s: 0.35, stop_duration_s: 0.2});
  assert.deepEqual(edge(300), {start_s: 2.75, start_duration_s: 0.2, stop_s: 3});
});

test('names of new constraints are new', () => {
  const ops = [op({do: 'constrain@1', constraint: {type: 'Distance', name: 'left hand 2'}}),
    op({do: 'constrain@1', detect: 'supports'})];
  assert.equal(newConstraintName('leftHand', ops, ['left hand 1']), 'left hand 3');
  assert.equal(newConstraintName('hips', ops, []), 'hips 1');
});

const same = {until: null, scale: 1};

test('legs are measured across joints between them', () => {
  const leg = (side: string, hips: number, first: number): JointWords[] => [
    joint(`${side}UpperLeg`, hips, [0.1, 0, 0]), joint('', first, [0, -0.2, 0]),
    joint(`${side}LowerLeg`, first + 1, [0, -0.2, 0.1]),
    joint(`${side}Foot`, first + 2, [0, 0, 0.5])];
  const joints = [joint('hips', -1, [0, 1, 0]), ...leg('left', 0, 1), ...leg('right', 0, 5)];
  assert.ok(Math.abs(legLength_m(joints)! - (Math.hypot(0.4, 0.1) + 0.5)) < 1e-12);
  assert.equal(legLength_m(joints.slice(0, 5)), null);
});

test('a constraint is dragged in its operation, or by hand if it was found', () => {
  const ops = [op({do: 'cut@1'}), op({do: 'constrain@1', adapt: true, constraint: {
    type: 'Distance', name: 'rail', segment: 'leftHand', position_m: [1, 1, 1], stop_s: 2}})];
  assert.deepEqual(steps(constraintChange(found('rail'), [0, 0.1, -0.0501], ops, same), ops),
    [{replace: 1, op: {do: 'constrain@1', adapt: true, constraint: {type: 'Distance',
      name: 'rail', segment: 'leftHand', position_m: [1, 1.1, 0.95], stop_s: 2}}}]);
  const stance = found('found leftFoot flat 1');
  assert.deepEqual(steps(constraintChange(stance, [0, 0.1, 0], ops, same), ops), [{insert: 2,
    op: {do: 'constrain@1', changes: [{name: 'found leftFoot flat 1', position_m: stance.p_in_world!
      .map((x, k) => x + [0, 0.1, 0][k])}], adapt: true}}]);
  assert.equal(constraintChange({...stance, p_in_world: null}, [0, 0, 0], ops, same), null);
  assert.equal(constraintChange({...stance, draggable: false}, [0, 0, 0], ops, same), null);
  // It was removed meanwhile.
  assert.equal(constraintChange(found('rail'), [0, 1, 0], ops, same)!([]), null);
  // An avatar with legs of half the length.
  const onAvatar = [...ops, op({do: 'retarget@1', avatar: 'a'})];
  const moved = (until: number | null) => steps(constraintChange(found('rail'), [0, 0.1, 0], ops,
    {until, scale: 2}), onAvatar)![0];
  const movedTo = (y: number) => ({replace: 1, op: {...ops[1].keys, constraint: {
    type: 'Distance', name: 'rail', segment: 'leftHand', position_m: [1, y, 1], stop_s: 2}}});
  assert.deepEqual(moved(null), movedTo(1.2));
  assert.deepEqual(moved(2), movedTo(1.1));
});

test('constraints are active between their times', () => {
  assert.deepEqual([0.9, 0.9996, 1.5, 2, 2.1].map((s) => isActiveAt(found('a'), s)),
    [false, true, true, true, false]);
  assert.ok(isActiveAt({...found('a'), start_s: null, stop_s: null}, 99));
});

test('a change goes to the operation that acts last before the shown motion', () => {
  const ops = [op({do: 'contacts@1'}), op({do: 'event@1'}), op({do: 'retarget@1'})];
  assert.equal(opToChange(ops, 2, 'contacts@1'), 0);
  assert.equal(opToChange(ops, 3, 'contacts@1'), null);
  assert.equal(opToChange(ops, 0, 'contacts@1'), null);
  assert.equal(opToChange([op({do: 'contacts@1'}, true)], 1, 'contacts@1'), null);
});
