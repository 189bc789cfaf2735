// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// A body of tubes around the joints of walker.mjs, as a binary glTF with a skin: the avatar
// of tests on machines without other avatars.

import {JOINTS} from './walker.mjs';

const AROUND = 14;
const RINGS = 7;

const radiusOf = (name) => (/hips|spine|hest/.test(name) ? 0.12
  : /UpperLeg/.test(name) ? 0.075 : /head/.test(name) ? 0.085 : /LowerLeg/.test(name) ? 0.055
    : /Hand|Foot/.test(name) ? 0.035 : /neck/.test(name) ? 0.05 : 0.045);

/** Places of the joints at rest, in the world. */
function restPlaces() {
  const places = [];
  for (const {parent, rest: {p}} of JOINTS) {
    places.push(parent < 0 ? p : p.map((v, k) => v + places[parent][k]));
  }
  return places;
}

function addTube(mesh, from, to, joint, radius) {
  const along = to.map((v, k) => v - from[k]);
  const length = Math.hypot(...along) || 1;
  const u = along.map((v) => v / length);
  const side = Math.abs(u[1]) < 0.9 ? [u[2], 0, -u[0]] : [1, 0, 0];
  const size = Math.hypot(...side);
  const s = side.map((v) => v / size);
  const t = [u[1] * s[2] - u[2] * s[1], u[2] * s[0] - u[0] * s[2], u[0] * s[1] - u[1] * s[0]];
  const first = mesh.positions.length / 3;
  for (let ring = 0; ring < RINGS; ++ring) {
    const share = ring / (RINGS - 1);
    const r = radius * Math.sqrt(Math.max(1 - (2 * share - 1) ** 4, 0.05));
    for (let i = 0; i < AROUND; ++i) {
      const [a, b] = [Math.cos(2 * Math.PI * i / AROUND), Math.sin(2 * Math.PI * i / AROUND)];
      const normal = s.map((v, k) => a * v + b * t[k]);
      mesh.positions.push(...from.map((v, k) => v + share * along[k] + r * normal[k]));
      mesh.normals.push(...normal);
      mesh.joints.push(joint, 0, 0, 0);
      mesh.weights.push(1, 0, 0, 0);
    }
  }
  for (let ring = 0; ring + 1 < RINGS; ++ring) {
    for (let i = 0; i < AROUND; ++i) {
      const [p, q] = [first + ring * AROUND + i, first + ring * AROUND + (i + 1) % AROUND];
      mesh.triangles.push(p, q, p + AROUND, q, q + AROUND, p + AROUND);
    }
  }
}

/** The whole file. Node i + 1 is joint i; node 0 carries the mesh. */
export function avatarFile() {
  const places = restPlaces();
  const mesh = {positions: [], normals: [], joints: [], weights: [], triangles: []};
  JOINTS.forEach(({name, parent}, i) => {
    if (parent >= 0) addTube(mesh, places[parent], places[i], parent, radiusOf(JOINTS[parent].name));
    else addTube(mesh, places[i], [0, places[i][1] + 0.1, 0], i, radiusOf(name));
  });
  const inverse = places.flatMap(([x, y, z]) =>
    [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, -y, -z, 1]);
  const parts = [
    [new Float32Array(mesh.positions), 5126, 'VEC3'], [new Float32Array(mesh.normals), 5126, 'VEC3'],
    [new Uint8Array(mesh.joints), 5121, 'VEC4'], [new Float32Array(mesh.weights), 5126, 'VEC4'],
    [new Uint16Array(mesh.triangles), 5123, 'SCALAR'], [new Float32Array(inverse), 5126, 'MAT4'],
  ];
  const wide = {SCALAR: 1, VEC3: 3, VEC4: 4, MAT4: 16};
  const bytes = [];
  const views = [];
  const accessors = [];
  let at = 0;
  parts.forEach(([values, componentType, type], i) => {
    const chunk = Buffer.from(values.buffer);
    views.push({buffer: 0, byteOffset: at, byteLength: chunk.length});
    accessors.push({bufferView: i, componentType, type, count: values.length / wide[type]});
    const padding = Buffer.alloc((4 - chunk.length % 4) % 4);
    bytes.push(chunk, padding);
    at += chunk.length + padding.length;
  });
  const extent = (pick) => [0, 1, 2].map((k) => pick(...mesh.positions.filter((_, i) => i % 3 === k)));
  Object.assign(accessors[0], {min: extent(Math.min), max: extent(Math.max)});
  const children = (i) => JOINTS.flatMap(({parent}, k) => (parent === i ? [k + 1] : []));
  const json = {
    asset: {version: '2.0'}, scene: 0, scenes: [{nodes: [0, 1]}],
    nodes: [{name: 'body', mesh: 0, skin: 0}, ...JOINTS.map(({name, rest}, i) => ({name,
      translation: rest.p, ...(children(i).length > 0 ? {children: children(i)} : {})}))],
    skins: [{joints: JOINTS.map((_, i) => i + 1), inverseBindMatrices: 5}],
    meshes: [{primitives: [{attributes: {POSITION: 0, NORMAL: 1, JOINTS_0: 2, WEIGHTS_0: 3},
      indices: 4, material: 0}]}],
    materials: [{pbrMetallicRoughness: {baseColorFactor: [0.75, 0.62, 0.5, 1],
      metallicFactor: 0}}],
    accessors, bufferViews: views, buffers: [{byteLength: at}],
  };
  const text = Buffer.from(JSON.stringify(json));
  const head = Buffer.concat([text, Buffer.alloc((4 - text.length % 4) % 4, 0x20)]);
  const body = Buffer.concat(bytes);
  const out = Buffer.alloc(12 + 8 + head.length + 8 + body.length);
  out.write('glTF', 0);
  out.writeUInt32LE(2, 4);
  out.writeUInt32LE(out.length, 8);
  out.writeUInt32LE(head.length, 12);
  out.write('JSON', 16);
  head.copy(out, 20);
  out.writeUInt32LE(body.length, 20 + head.length);
  out.write('BIN\0', 24 + head.length);
  body.copy(out, 28 + head.length);
  return out;
}
