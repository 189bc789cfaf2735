// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Shared by the checks that run in node: tables of joint places, and the distances of a
// scene's bones from them.
import { readFile } from 'node:fs/promises';
import { Vector3 } from 'three';

/// Rows of joints.csv, by frame: maps from joint to place.
export async function readPlaces(path) {
  const frames = [];
  const lines = (await readFile(path, 'utf8')).trim().split('\n');
  for (const line of lines.slice(1)) {
    const [frame, time, joint, x, y, z] = line.split(',');
    frames[frame] ??= { time: Number(time), joints: new Map() };
    frames[frame].joints.set(joint, new Vector3(Number(x), Number(y), Number(z)));
  }
  return frames;
}

/// Returns the largest distance of the nodes `find(joint)` from their places in `frames`. [mm]
/// `pose(frame)` poses the scene; `unit` is the scene's unit in metres.
export function largestDistance(frames, find, pose, unit = 1) {
  let largest = 0;
  let places = 0;
  const place = new Vector3();
  frames.forEach(({ joints }, frame) => {
    pose(frame);
    for (const [joint, expected] of joints) {
      const node = find(joint);
      if (!node) throw new Error(`there is no joint ${joint}`);
      node.getWorldPosition(place);
      const distance = 1000 * place.multiplyScalar(unit).distanceTo(expected);
      if (!(distance <= largest)) largest = distance;
      ++places;
    }
  });
  if (places === 0) throw new Error('there are no places to compare with');
  return largest;
}

/// The times of an animation's keys, which must be frames of this table. Keys are floats.
export function keyTimes(clip, frames) {
  const times = clip.tracks.reduce((a, b) => (a.times.length >= b.times.length ? a : b)).times;
  if (times.length !== frames.length) {
    throw new Error(`${times.length} keys for ${frames.length} frames`);
  }
  times.forEach((time, frame) => {
    if (Math.abs(time - frames[frame].time) > 1e-6 * Math.max(1, time)) {
      throw new Error(`frame ${frame} is at ${time}, not ${frames[frame].time} s`);
    }
  });
  return times;
}

/// The parts of a GLB. Leaves out meshes and materials, as node cannot decode pictures.
export async function readGlb(path) {
  const bytes = await readFile(path);
  const jsonBytes = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.subarray(20, 20 + jsonBytes).toString());
  for (const list of ['meshes', 'materials', 'textures', 'images', 'samplers', 'skins']) {
    delete json[list];
  }
  for (const node of json.nodes) {
    delete node.mesh;
    delete node.skin;
  }
  return { json, buffer: bytes.subarray(20 + jsonBytes + 8) };
}

/// A GLB again, as the ArrayBuffer that loaders want.
export function packGlb({ json, buffer }) {
  let text = Buffer.from(JSON.stringify(json));
  text = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, 0x20)]);
  const data = Buffer.concat([buffer, Buffer.alloc((4 - (buffer.length % 4)) % 4)]);
  const head = Buffer.alloc(20);
  head.write('glTF');
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(20 + text.length + (data.length ? 8 + data.length : 0), 8);
  head.writeUInt32LE(text.length, 12);
  head.write('JSON', 16);
  const parts = [head, text];
  if (data.length) {
    const chunk = Buffer.alloc(8);
    chunk.writeUInt32LE(data.length, 0);
    chunk.write('BIN\0', 4);
    parts.push(chunk, data);
  }
  const all = Buffer.concat(parts);
  return all.buffer.slice(all.byteOffset, all.byteOffset + all.length);
}

/// Loads `glb` with three's loader and these plugins.
export async function loadGltf(glb, ...plugins) {
  globalThis.self ??= globalThis;
  const { GLTFLoader } = await import('three/addons/loaders/GLTFLoader.js');
  const loader = new GLTFLoader();
  for (const plugin of plugins) loader.register(plugin);
  return loader.parseAsync(packGlb(glb), '');
}
