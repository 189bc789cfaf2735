// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Decodes server messages as they were encoded; rejects truncated messages.

import assert from 'node:assert/strict';
import test from 'node:test';
import {MotionBlock, PointBlock} from '../src/protocol/decode_blocks';
import {decodeFrame, SceneFrame} from '../src/protocol/decode_frame';
import {decodeThumbnail} from '../src/protocol/decode_thumbnail';
import {readServerWords} from '../src/protocol/protocol';

const two = [{joints: new Array(2)}, {joints: new Array(1)}];

/** Two skeletons: one with pose, uncertainty, a support triangle and tracking data; one that
 *  is absent. Written by hand after docs/formats/README.md. */
function frameBytes(frame = 7): ArrayBuffer {
  const bytes = new ArrayBuffer(24 + (4 + 12 + 32 + 8 + 4 + 16 + 24 + 8) + 4 + 8);
  const view = new DataView(bytes);
  view.setUint8(0, 1);
  view.setUint8(1, 1);
  view.setUint16(2, 2, true);
  view.setUint32(4, frame, true);
  view.setFloat64(8, 0.25, true);
  view.setFloat64(16, 12.5, true);
  let at = 24;
  view.setUint8(at, 31);
  view.setUint16(at + 2, 2, true);
  at += 4;
  const floats = (...values: number[]): void => {
    for (const value of values) {
      view.setFloat32(at, value, true);
      at += 4;
    }
  };
  floats(1, 2, 3);
  floats(0, 0, 0, 1, 0.5, 0.5, 0.5, 0.5);
  floats(0.25, 0.5);
  view.setUint8(at, 0);
  view.setUint8(at + 1, 2);
  at += 4;
  floats(4, 5, 6);
  view.setUint16(at, 3, true);
  at += 4;
  floats(0, 0, 1, 0, 0, 1);
  floats(0.25, 0.5);
  floats(0.75);
  view.setUint8(at, 9);
  at += 4;
  view.setUint16(at + 2, 1, true);
  return bytes;
}

function block(magic: string, ...parts: ArrayBuffer[]): ArrayBuffer {
  const head = new ArrayBuffer(16);
  [...magic].forEach((letter, i) => new DataView(head).setUint8(i, letter.charCodeAt(0)));
  new DataView(head).setUint32(4, 1, true);
  const whole = new Uint8Array(16 + parts.reduce((sum, part) => sum + part.byteLength, 0));
  whole.set(new Uint8Array(head));
  let at = 16;
  for (const part of parts) {
    whole.set(new Uint8Array(part), at);
    at += part.byteLength;
  }
  return whole.buffer;
}

test('a frame is read as it was written', () => {
  const frame = new SceneFrame(two);
  const bytes = frameBytes();
  assert.equal(decodeFrame(new DataView(bytes), 0, frame), bytes.byteLength);
  assert.equal(frame.frame, 7);
  assert.equal(frame.time_s, 0.25);
  assert.equal(frame.sent_s, 12.5);
  const [there, gone] = frame.skeletons;
  assert.deepEqual([...there.root_in_world], [1, 2, 3]);
  assert.deepEqual([...there.parent_from_joint], [0, 0, 0, 1, 0.5, 0.5, 0.5, 0.5]);
  assert.deepEqual([...there.sigma_m], [0.25, 0.5]);
  assert.deepEqual([...there.source], [0, 2]);
  assert.deepEqual([...there.centre_of_mass_in_world], [4, 5, 6]);
  assert.equal(there.corners, 3);
  assert.deepEqual([...there.support_xz.subarray(0, 6)], [0, 0, 1, 0, 0, 1]);
  assert.ok(there.hasZmp);
  assert.deepEqual([...there.zmp_xz], [0.25, 0.5]);
  assert.equal(there.residual_px, 0.75);
  assert.equal(there.bears, 9);
  assert.equal(gone.hasPose, false);
  assert.equal(gone.hasZmp, false);
  assert.equal(gone.hasTracking, false);
});

test('a zero moment point needs a balance, and a copied frame has it', () => {
  const bytes = frameBytes();
  const frame = new SceneFrame(two);
  decodeFrame(new DataView(bytes), 0, frame);
  const copy = new SceneFrame(two);
  copy.skeletons[0].copy(frame.skeletons[0]);
  assert.ok(copy.skeletons[0].hasZmp);
  assert.deepEqual([...copy.skeletons[0].zmp_xz], [0.25, 0.5]);
  const view = new DataView(new ArrayBuffer(24 + 4));
  new Uint8Array(view.buffer).set([1, 1, 1, 0]);
  view.setUint8(24, 16);
  view.setUint16(26, 1, true);
  const alone = new SceneFrame([two[1]]);
  assert.equal(decodeFrame(view, 0, alone), 28);
  assert.equal(alone.skeletons[0].hasZmp, false);
});

test('a frame that is truncated anywhere is rejected', () => {
  const bytes = frameBytes();
  for (let length = 0; length < bytes.byteLength; ++length) {
    const end = decodeFrame(new DataView(bytes, 0, length), 0, new SceneFrame(two));
    assert.equal(end, -1, `${length} bytes`);
  }
});

test('a frame of another scene is refused', () => {
  const view = new DataView(frameBytes());
  assert.equal(decodeFrame(view, 0, new SceneFrame([{joints: new Array(2)}])), -1);
  assert.equal(decodeFrame(view, 0, new SceneFrame([{joints: new Array(3)}, two[1]])), -1);
});

test('a polygon with too many corners does not shift the data after it', () => {
  const corners = 200;
  const bytes = new ArrayBuffer(24 + 4 + 16 + 8 * corners);
  const view = new DataView(bytes);
  view.setUint8(0, 1);
  view.setUint8(1, 1);
  view.setUint16(2, 1, true);
  view.setUint8(24, 4);
  view.setUint16(26, 1, true);
  view.setUint16(40, corners, true);
  const frame = new SceneFrame([two[1]]);
  assert.equal(decodeFrame(view, 0, frame), bytes.byteLength);
  assert.ok(frame.skeletons[0].corners < corners);
});

test('a block gives every frame, in any order', () => {
  const bytes = block('MRMB', frameBytes(0), frameBytes(1), frameBytes(2));
  new DataView(bytes).setUint32(8, 3, true);
  new DataView(bytes).setUint32(12, 2, true);
  const frame = new SceneFrame(two);
  const whole = new MotionBlock(bytes, frame);
  for (const i of [2, 0, 1]) {
    whole.read(i, frame);
    assert.equal(frame.frame, i);
  }
});

test('blocks that are not whole say what is wrong', () => {
  const cut = block('MRMB', frameBytes(0));
  new DataView(cut).setUint32(8, 2, true);
  new DataView(cut).setUint32(12, 2, true);
  assert.throws(() => new MotionBlock(cut, new SceneFrame(two)), /frame 1 is truncated/);
  assert.throws(() => new MotionBlock(block('GLTF'), new SceneFrame(two)), /MRMB/);
  const huge = block('MRMB');
  new DataView(huge).setUint32(8, 0xffffffff, true);
  new DataView(huge).setUint32(12, 2, true);
  assert.throws(() => new MotionBlock(huge, new SceneFrame(two)), /truncated/);
  const points = block('MRPB');
  new DataView(points).setUint32(8, 10, true);
  new DataView(points).setUint32(12, 10, true);
  assert.throws(() => new PointBlock(points), /truncated/);
});

function frameOfOnePoint(): ArrayBuffer {
  return new Float32Array([1, 2, 3, 0]).buffer;
}

test('points that are not there stay NaN', () => {
  const values = new ArrayBuffer(32);
  const view = new DataView(values);
  [1, 2, 3].forEach((v, k) => view.setFloat32(4 * k, v, true));
  view.setUint8(12, 1);
  [16, 20, 24].forEach((at) => view.setFloat32(at, NaN, true));
  const bytes = block('MRPB', values);
  new DataView(bytes).setUint32(8, 1, true);
  new DataView(bytes).setUint32(12, 2, true);
  const [p, source] = [new Float32Array(6), new Uint8Array(2)];
  new PointBlock(bytes).read(0, p, source);
  assert.deepEqual([...p], [1, 2, 3, NaN, NaN, NaN]);
  assert.deepEqual([...source], [1, 0]);
  assert.equal(new PointBlock(bytes).firstSeen(), 0);
  const later = block('MRPB', values.slice(16), values.slice(16), frameOfOnePoint());
  new DataView(later).setUint32(8, 3, true);
  new DataView(later).setUint32(12, 1, true);
  assert.equal(new PointBlock(later).firstSeen(), 2);
});

test('a thumbnail is read with its tags', () => {
  const bytes = new ArrayBuffer(8 + 36 + 3);
  const view = new DataView(bytes);
  view.setUint8(0, 2);
  view.setUint8(1, 5);
  view.setUint16(2, 1280, true);
  view.setUint16(4, 720, true);
  view.setUint16(6, 1, true);
  view.setInt32(8, -3, true);
  for (let k = 0; k < 8; ++k) view.setFloat32(12 + 4 * k, k, true);
  view.setUint8(44, 9);
  const read = decodeThumbnail(bytes)!;
  assert.equal(read.camera, 5);
  assert.deepEqual([read.width_px, read.height_px], [1280, 720]);
  assert.deepEqual(read.tags, [{id: -3, corners_px: [0, 1, 2, 3, 4, 5, 6, 7]}]);
  assert.deepEqual([...read.jpeg], [9, 0, 0]);
  assert.equal(decodeThumbnail(bytes.slice(0, 40)), null);
});

test('texts of another version, kind or form are rejected with a reason', () => {
  const why = (text: string): string => {
    const words = readServerWords(text);
    return words.type === 'bad' ? words.why : '';
  };
  assert.match(why('{'), /not JSON/);
  assert.match(why('3'), /no type/);
  assert.match(why('{"type":"dance"}'), /dance/);
  assert.match(why('{"type":"scene","version":2,"skeletons":[]}'), /version 2/);
  assert.match(why('{"type":"scene","version":1,"skeletons":[{"name":"a","joints":' +
    '[{"parent":0}]}]}'), /before its parent/);
  assert.equal(readServerWords('{"type":"error","text":"no"}').type, 'error');
});
