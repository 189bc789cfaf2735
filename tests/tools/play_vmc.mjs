// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// node play_vmc.mjs FOLDER NAME AVATAR.(vrm|glb) raw|normalised: shows NAME.vmc on an
// avatar with pixiv's three-vrm, decoded by npm's osc. A GLB without VRM's extension
// becomes a VRM 1.0 by NAME.json. Exit 1 when a bone is more than 1 mm from its place in
// NAME.csv, or receives another offset than the avatar's; 77 without three-vrm or osc.
import { readFile } from 'node:fs/promises';

const LIMIT_MM = 1;

let osc;
let vrm;
let judge;
let three;
try {
  osc = (await import('osc')).default;
  three = await import('three');
  vrm = await import('@pixiv/three-vrm');
  judge = await import('./joint_places.mjs');
} catch {
  console.log('skipped: osc or three-vrm is missing; run `npm ci` in tests/tools');
  process.exit(77);
}

/// The packets of a .vmc, each as its messages.
async function readFrames(path) {
  const bytes = await readFile(path);
  const frames = [];
  for (let at = 0; at < bytes.length;) {
    const size = bytes.readUInt32BE(at);
    const packet = bytes.subarray(at + 4, at + 4 + size);
    frames.push(osc.readPacket(packet, {}).packets);
    at += 4 + size;
  }
  return frames;
}

/// Makes a VRM of a body; `bones` maps its nodes to bones. Leaves out its look.
function asVrm(glb, bones) {
  const { json } = glb;
  delete json.animations;
  if (json.extensions?.VRM) {
    const { meta, humanoid, specVersion, exporterVersion } = json.extensions.VRM;
    delete meta.texture;
    json.extensions = { VRM: { meta, humanoid, specVersion, exporterVersion } };
    return glb;
  }
  const humanBones = {};
  for (const [bone, name] of Object.entries(bones)) {
    humanBones[bone] = { node: json.nodes.findIndex((node) => node.name === name) };
  }
  json.extensionsUsed = ['VRMC_vrm'];
  json.extensions = {
    VRMC_vrm: {
      specVersion: '1.0',
      meta: { name: 'body', authors: ['nobody'], licenseUrl: 'https://vrm.dev/licenses/1.0/' },
      humanoid: { humanBones },
    },
  };
  return glb;
}

const [folder, name, avatarPath, rest] = process.argv.slice(2);
const places = await judge.readPlaces(`${folder}/${name}.csv`);
const bones = JSON.parse(await readFile(`${folder}/${name}.json`, 'utf8'));
const body = await judge.loadGltf(
  asVrm(await judge.readGlb(avatarPath), bones),
  (parser) => new vrm.VRMLoaderPlugin(parser),
);
const avatar = body.userData.vrm;
const frames = await readFrames(`${folder}/${name}.vmc`);
if (frames.length !== places.length) throw new Error(`${frames.length} packets`);

// Unity's axes are glTF's with X mirrored; UniVRM mirrors Z of a VRM 0.x, which faces back.
const facesBack = avatar.meta.metaVersion === '0';
const place = ([x, y, z]) =>
  facesBack ? new three.Vector3(x, y, -z) : new three.Vector3(-x, y, z);
const turn = ([x, y, z, w]) =>
  facesBack ? new three.Quaternion(-x, -y, z, w) : new three.Quaternion(x, -y, -z, w);
const boneName = (unity) => unity[0].toLowerCase() + unity.slice(1);
const nodeOf = (unity) => rest === 'raw'
  ? avatar.humanoid.getRawBoneNode(boneName(unity))
  : avatar.humanoid.getNormalizedBoneNode(boneName(unity));

let farthestOffset = 0;
vrm.VRMUtils.rotateVRM0(avatar);
const pose = (frame) => {
  for (const { address, args } of frames[frame]) {
    if (address !== '/VMC/Ext/Bone/Pos') continue;
    const [unity, ...numbers] = args;
    const node = nodeOf(unity);
    if (!node) throw new Error(`the avatar has no ${unity}`);
    const position = place(numbers.slice(0, 3));
    // Fast motions also turn the nodes between bones, so only the first frame is compared
    // at rest.
    if (unity !== 'Hips' && frame === 0) {
      farthestOffset = Math.max(farthestOffset, 1000 * position.distanceTo(node.position));
    }
    // The normalised rig has its own bone lengths, and translates the hips only.
    if (rest === 'raw' || unity === 'Hips') node.position.copy(position);
    node.quaternion.copy(turn(numbers.slice(3)));
  }
  if (rest !== 'raw') avatar.humanoid.update();
  avatar.scene.updateMatrixWorld(true);
};
const largest = judge.largestDistance(
  places, (joint) => avatar.humanoid.getRawBoneNode(joint), pose);
console.log(`${name} on ${avatarPath}: largest distance ${largest.toFixed(5)} mm, ` +
  `offsets ${farthestOffset.toFixed(5)} mm`);
process.exit(largest <= LIMIT_MM && farthestOffset <= LIMIT_MM ? 0 : 1);
