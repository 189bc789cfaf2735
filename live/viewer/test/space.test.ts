// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Poses, skins, views and drags.

import assert from 'node:assert/strict';
import test from 'node:test';
import type {BufferGeometry, Mesh, MeshBasicMaterial} from 'three';
import type {Theme} from '../src/base/theme';
import {BalanceView, carries} from '../src/scene/balance_view';
import {boneMatrix, flatten} from '../src/scene/bone_shapes';
import {SkeletonFrame} from '../src/protocol/decode_frame';
import {dragInPlane, dragVertically} from '../src/scene/drag_plane';
import {framing, leash, Orbit, VIEW_ANGLE} from '../src/scene/orbit';
import {blendFrames, PosedSkeleton} from '../src/scene/posed_skeleton';
import type {JointWords, Quaternion, Vector} from '../src/protocol/protocol';
import {Quality} from '../src/scene/quality';
import {multiply, multiplyInverse, turn} from '../src/scene/quaternions';
import {frustumLines} from '../src/scene/rig_view';
import {NodeDriver} from '../src/scene/skin_fit';

const HALF = Math.SQRT1_2;
const none: Quaternion = [0, 0, 0, 1];
const close = (a: ArrayLike<number>, b: ArrayLike<number>, within = 1e-6): void => {
  assert.equal(a.length, b.length);
  for (let i = 0; i < a.length; ++i) {
    assert.ok(Math.abs(a[i] - b[i]) <= within, `${[...Array.from(a)]} is not ${Array.from(b)}`);
  }
};
const joint = (parent: number, p: Vector, q: Quaternion = none): JointWords =>
  ({name: `j${p}`, parent, bone: '', rest: {p, q}});
const chain = {joints: [joint(-1, [0, 1, 0]), joint(0, [1, 0, 0]), joint(1, [1, 0, 0])]};

test('rotated as a product of quaternions rotates', () => {
  const a = [0, 0, HALF, HALF]; // A quarter turn about z.
  const b = [HALF, 0, 0, HALF]; // About x.
  const v = [0, 1, 0];
  const once: number[] = [0, 0, 0];
  turn(once, 0, b, 0, v, 0);
  turn(once, 0, a, 0, once, 0);
  const product = [0, 0, 0, 0];
  multiply(product, 0, a, 0, b, 0);
  const twice: number[] = [0, 0, 0];
  turn(twice, 0, product, 0, v, 0);
  close(once, twice);
  close(once, [0, 0, 1]);
  multiplyInverse(product, 0, a, 0, product, 0);
  close(product, b);
});

test('a bent chain has its joints where geometry puts them', () => {
  const pose = new PosedSkeleton(chain);
  close(pose.p_in_world, [0, 1, 0, 1, 1, 0, 2, 1, 0]);
  const frame = new SkeletonFrame(3);
  frame.root_in_world.set([5, 0, 0]);
  frame.parent_from_joint.set([0, 0, HALF, HALF], 4); // The elbow bends up.
  pose.setFrame(frame);
  close(pose.p_in_world, [5, 0, 0, 6, 0, 0, 6, 1, 0]);
});

test('a heading is where the body looks, however its joints rest', () => {
  // A quarter turn about +Y: it looks towards +X.
  const turned: Quaternion = [0, HALF, 0, HALF];
  const odd: Quaternion = [HALF, 0, 0, HALF];
  for (const rest of [none, odd]) {
    const pose = new PosedSkeleton({joints: [joint(-1, [0, 1, 0], rest)]});
    assert.equal(pose.heading(), 0);
    const frame = new SkeletonFrame(1);
    multiply(frame.parent_from_joint, 0, turned, 0, rest, 0);
    pose.setFrame(frame);
    assert.ok(Math.abs(pose.heading() - Math.PI / 2) < 1e-6);
  }
});

test('between two frames bones keep their lengths, the short way round', () => {
  const [a, b, into] = [new SkeletonFrame(1), new SkeletonFrame(1), new SkeletonFrame(1)];
  a.hasPose = b.hasPose = true;
  a.root_in_world.set([0, 0, 0]);
  b.root_in_world.set([2, 4, 6]);
  b.parent_from_joint.set([0, 0, -HALF, -HALF]); // The same as (0, 0, HALF, HALF).
  blendFrames(into, a, b, 0.5);
  close(into.root_in_world, [1, 2, 3]);
  close(into.parent_from_joint, [0, 0, Math.sin(Math.PI / 8), Math.cos(Math.PI / 8)]);
});

test('nodes with axes of their own follow the joints in the world', () => {
  // The joints' axes are the world's; the file's are turned about z, an extra node between.
  const odd: Quaternion = [0, 0, HALF, HALF];
  const between: Quaternion = [HALF, 0, 0, HALF];
  const joint_rest = new Float32Array([...none, ...none]);
  const parent_of_second = [0, 0, 0, 0];
  multiply(parent_of_second, 0, odd, 0, between, 0);
  const node_rest = new Float32Array([...odd, ...odd]);
  const driver = new NodeDriver(joint_rest, node_rest,
    new Float32Array([...none, ...parent_of_second]), Int16Array.from([-1, 0]));
  const world = new Float32Array([0, HALF, 0, HALF, HALF, 0, 0, HALF]);
  const local = [new Float32Array(4), new Float32Array(4)];
  driver.local(0, world, local[0]);
  driver.local(1, world, local[1]);
  // The node in the world: as the joint turned away from rest.
  const wanted = new Float32Array(8);
  multiply(wanted, 0, world, 0, odd, 0);
  multiply(wanted, 4, world, 4, odd, 0);
  close(local[0], wanted.subarray(0, 4));
  const reached = [...local[0]];
  multiply(reached, 0, reached, 0, between, 0);
  multiply(reached, 0, reached, 0, local[1], 0);
  close(reached, wanted.subarray(4));
});

test('a view frames the given points', () => {
  const points = [-0.5, 0, 0, 0.5, 1.8, 0.3, 0.1, 1, -0.2];
  for (const [azimuth, height, aspect] of [[0, 0, 1], [0.7, 0.3, 1.8], [3, 1.5, 0.5]]) {
    const view = framing(points, azimuth, height, aspect)!;
    const orbit = new Orbit();
    orbit.goTo(view, true);
    const eye = orbit.camera.position.toArray();
    const toward = view.target_in_world.map((v, k) => v - eye[k]);
    const size = Math.hypot(...toward);
    for (let i = 0; i < points.length; i += 3) {
      const ray = [0, 1, 2].map((k) => points[i + k] - eye[k]);
      const depth = ray.reduce((sum, v, k) => sum + v * toward[k], 0) / size;
      const off = Math.sqrt(Math.hypot(...ray) ** 2 - depth ** 2);
      // Within the circle around the picture.
      assert.ok(off / depth < Math.tan(VIEW_ANGLE / 2) * Math.hypot(1, aspect));
    }
  }
  assert.equal(framing([NaN, NaN, NaN], 0, 0, 1), null);
});

test('the eye moves to its target by the shorter way, and stops', () => {
  const orbit = new Orbit();
  const view = {target_in_world: [1, 1, 1] as Vector, distance_m: 3, azimuth: 0, height: 0};
  orbit.goTo({...view, azimuth: 6.2}, true);
  orbit.goTo(view, false);
  let pictures = 0;
  let widest = 0;
  while (orbit.glide(1 / 60) && pictures < 300) {
    ++pictures;
    widest = Math.max(widest, Math.abs(orbit.azimuth));
  }
  assert.ok(pictures > 10 && pictures < 200);
  assert.ok(widest < 2 * Math.PI - 6.2 + 1e-6);
  assert.ok(Math.abs(orbit.azimuth) < 0.01);
  close(orbit.target.toArray(), [1, 1, 1], 0.01);
});

test('a panned eye keeps its distance', () => {
  const orbit = new Orbit();
  const before = orbit.distance_m;
  orbit.controls.domElement = {clientHeight: 500} as HTMLElement;
  orbit.controls.pan(30, -20);
  assert.ok(orbit.target.distanceTo(new Orbit().target) > 0.01);
  assert.ok(Math.abs(orbit.distance_m - before) < 1e-9);
});

test('the eye follows a walking body, not a swaying one', () => {
  close(leash(0.15, -0.2), [0, 0]);
  const [dx, dz] = leash(3, 4);
  assert.ok(Math.abs(Math.hypot(3 - dx, 4 - dz) - 0.25) < 1e-9);
  assert.ok(Math.abs(dx / dz - 0.75) < 1e-9);
});

test('a drag stays in its plane, a vertical one on its line', () => {
  const eye: Vector = [0, 1, 5];
  const at = dragInPlane(eye, [0.1, -0.05, -1], [0, 1, 0], [0, 0, 1])!;
  close(at, [0.5, 0.75, 0]);
  assert.equal(dragInPlane(eye, [1, 0, 0], [0, 1, 0], [0, 0, 1]), null);
  assert.equal(dragInPlane(eye, [0, 0, 1], [0, 1, 0], [0, 0, 1]), null, 'behind the eye');
  close(dragVertically(eye, [0, 0.1, -1], [0, 1, 0])!, [0, 1.5, 0]);
  assert.equal(dragVertically(eye, [0, -1, 0], [0, 0, 5]), null);
});

test('a polygon supports points above it in either order of its corners', () => {
  const square = [0, 0, 1, 0, 1, 1, 0, 1];
  const reversed = [0, 1, 1, 1, 1, 0, 0, 0];
  for (const corners of [square, reversed]) {
    assert.ok(carries(corners, 4, 0.5, 0.9));
    assert.ok(!carries(corners, 4, 1.1, 0.5));
  }
  assert.ok(!carries(square, 2, 0.5, 0));
});

test('the zero moment point is a ring on the floor: red outside of the polygon, none in flight', () => {
  const view = new BalanceView([10, 0, 0]);
  view.paint({colour: (name: string) => (name === 'good' ? 'rgb(0, 255, 0)' : 'rgb(255, 0, 0)')} as
    unknown as Theme);
  const rings = view.object.children.filter((part) =>
    ['RingGeometry', 'CircleGeometry'].includes((part as Mesh).geometry.type)) as
    Mesh<BufferGeometry, MeshBasicMaterial>[];
  assert.equal(rings.length, 2);
  const frame = new SkeletonFrame(1);
  frame.support_xz.set([0, 0, 1, 0, 1, 1, 0, 1]);
  frame.corners = 4;
  frame.centre_of_mass_in_world.set([0.5, 1, 0.5]);
  const shownAt = (x: number, z: number): [number, number] => {
    frame.hasZmp = true;
    frame.zmp_xz.set([x, z]);
    view.update(frame, 0.25);
    for (const {visible, position} of rings) {
      assert.ok(visible);
      close([position.x, position.z], [x + 10, z], 1e-6);
      assert.ok(position.y > 0.25 && position.y < 0.27);
    }
    const {r, g} = rings[0].material.color;
    return [r, g];
  };
  assert.deepEqual(shownAt(0.5, 0.75), [0, 1]);
  assert.deepEqual(shownAt(0.5, 1.25), [1, 0]);
  frame.hasZmp = false;
  view.update(frame, 0.25);
  assert.ok(rings.every(({visible}) => !visible));
  view.dispose();
});

test('a camera sees points in front of it, not behind', () => {
  // From +Z towards the middle: x of the picture is +X of the world, y goes down.
  const lines = frustumLines({name: 'c', width_px: 101, height_px: 101, fx: 100, fy: 100,
    cx: 50, cy: 50, rms_px: null,
    world_from_camera: {p: [0, 1, 3], q: [1, 0, 0, 0]}});
  for (let i = 0; i < lines.length; i += 3) assert.ok(lines[i + 2] <= 3 + 1e-9);
  close(lines.slice(0, 2), [-0.24 * 0.505, 1 + 0.24 * 0.505], 1e-9);
});

test('a bone goes from joint to joint, its shadow lies on the floor', () => {
  const p = new Float32Array([0, 1, 0, 0.5, 2, 0.25]);
  const out = new Float32Array(16);
  boneMatrix(out, 0, p, 0, 3, 0.05, 1, 0, 0);
  close(out.subarray(12, 15), [1, 1, 0]);
  close([out[12] + out[4], out[13] + out[5], out[14] + out[6]], [1.5, 2, 0.25]);
  flatten(out, 0, 0.5);
  for (const row of [1, 5, 9]) assert.equal(out[row], 0);
  assert.equal(out[13], 0.5);
});

test('the resolution decreases if drawing is too slow, and only then', () => {
  const quality = new Quality(2, false);
  assert.equal(quality.ratio, 2);
  assert.equal(quality.second(3, 0, 1e6), false, 'few pictures change nothing');
  assert.equal(quality.second(30, 10, 1e6), false, 'one bad second changes nothing');
  assert.equal(quality.second(30, 10, 1e6), true);
  assert.equal(quality.ratio, 1.5);
  for (let i = 0; i < 100; ++i) quality.second(30, 30, 1e6);
  assert.equal(quality.ratio, 1.5, 'a resolution that was too slow is not tried again');
  const small = new Quality(1, true);
  for (let i = 0; i < 10; ++i) assert.equal(small.second(30, 5, 640 * 360), false);
});
