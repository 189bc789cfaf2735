// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// node three_joints.mjs MOTION.(bvh|glb) JOINTS.csv [METRES PER UNIT OF A BVH]: plays a
// motion with three.js. Exit 1 when a joint is more than 0.1 mm from its place, or a
// frame from its time; 77 when three.js is not installed.
import { readFile } from 'node:fs/promises';

const LIMIT_MM = 0.1;

let three;
let judge;
try {
  three = await import('three');
  judge = await import('./joint_places.mjs');
} catch {
  console.log('skipped: three is missing; run `npm ci` in tests/tools');
  process.exit(77);
}

async function load(path) {
  if (!path.endsWith('.bvh')) {
    const gltf = await judge.loadGltf(await judge.readGlb(path));
    return { root: gltf.scene, clip: gltf.animations[0] };
  }
  const { BVHLoader } = await import('three/addons/loaders/BVHLoader.js');
  const { skeleton, clip } = new BVHLoader().parse(await readFile(path, 'utf8'));
  return { root: skeleton.bones[0], clip };
}

const [path, table, unit = '0.01'] = process.argv.slice(2);
const frames = await judge.readPlaces(table);
const { root, clip } = await load(path);
const times = judge.keyTimes(clip, frames);
if (clip.tracks.some((track) => track.name.endsWith('.scale'))) {
  throw new Error('bones are scaled');
}
const mixer = new three.AnimationMixer(root);
const action = mixer.clipAction(clip);
action.setLoop(three.LoopOnce);
action.clampWhenFinished = true;
action.play();
// three.js removes the characters from names that a path cannot contain.
const named = (joint) => root.getObjectByName(three.PropertyBinding.sanitizeNodeName(joint));
const pose = (frame) => {
  action.time = times[frame];
  mixer.update(0);
  root.updateMatrixWorld(true);
};
const metres = path.endsWith('.bvh') ? Number(unit) : 1;
const largest = judge.largestDistance(frames, named, pose, metres);
console.log(`${path}: largest distance ${largest.toFixed(5)} mm, ${frames.length} frames`);
process.exit(largest <= LIMIT_MM ? 0 : 1);
