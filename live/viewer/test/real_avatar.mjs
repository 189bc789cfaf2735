// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// An avatar's file with the nodes that carry the bones of walker.mjs, so that the mock can
// send poses to it. Knows mixamo's, Unreal's and VRM's names.

import {readFileSync} from 'node:fs';
import {JOINTS} from './walker.mjs';

const MIXAMO = {hips: 'Hips', spine: 'Spine', chest: 'Spine1', upperChest: 'Spine2', neck: 'Neck',
  head: 'Head', headTop: 'HeadTop_End', Shoulder: 'Shoulder', UpperArm: 'Arm', LowerArm: 'ForeArm',
  Hand: 'Hand', HandTip: 'HandMiddle1', UpperLeg: 'UpLeg', LowerLeg: 'Leg', Foot: 'Foot',
  Toes: 'ToeBase'};

function readJson(bytes) {
  return JSON.parse(bytes.toString('utf8', 20, 20 + bytes.readUInt32LE(12)));
}

/** Returns the name of the node of this bone. */
function nodeOf(nodes, json, bone) {
  const vrm = json.extensions?.VRM?.humanoid?.humanBones?.find((b) => b.bone === bone);
  if (vrm) return vrm.node;
  const side = /^(left|right)/.exec(bone)?.[0] ?? '';
  const word = MIXAMO[bone.slice(side.length)] ?? bone;
  const name = `${side && side[0].toUpperCase() + side.slice(1)}${word}`;
  return nodes.findIndex((node) => new RegExp(`(^|:)${name}$`).test(node.name ?? ''));
}

/** The skin's description and joints for the mock's scene. Joints are at the places of the
 *  file's nodes. Joints without a node in the file keep their places and drive nothing. */
export function realAvatar(path) {
  const bytes = readFileSync(path);
  const json = readJson(bytes);
  const {nodes} = json;
  const node_index = JOINTS.map(({name}) => nodeOf(nodes, json, name));
  const rest = restOf(nodes, node_index);
  const [x, y] = rest[JOINTS.findIndex(({name}) => name === 'leftLowerArm')].p;
  return {bytes, words: {format: 'glb', nodes: JOINTS.map(({name}) => name), node_index,
    unit_from_m: 1, scene_from_file: [0, 0, 0, 1]}, rest, droop: Math.atan2(-y, x)};
}

/** Places of the driven nodes in the world (files whose nodes do not turn at rest, as the
 *  MakeHuman bodies are), as offsets from the parent joint. */
function restOf(nodes, node_index) {
  const parents = new Map();
  nodes.forEach((node, i) => (node.children ?? []).forEach((child) => parents.set(child, i)));
  const place = (i) => {
    const at = [0, 0, 0];
    for (let n = i; n !== undefined; n = parents.get(n)) {
      (nodes[n].translation ?? [0, 0, 0]).forEach((v, k) => { at[k] += v; });
    }
    return at;
  };
  const places = [];
  return JOINTS.map(({parent, rest}, i) => {
    const above = parent < 0 ? [0, 0, 0] : places[parent];
    places.push(node_index[i] >= 0 ? place(node_index[i])
      : rest.p.map((v, k) => v + above[k]));
    return {p: places[i].map((v, k) => v - above[k]), q: [0, 0, 0, 1]};
  });
}
