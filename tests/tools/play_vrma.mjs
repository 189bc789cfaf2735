// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// node play_vrma.mjs MOTION.vrma AVATAR.(vrm|glb) JOINTS.csv: plays a VRM animation on an
// avatar with pixiv's three-vrm. A GLB without VRM's extension becomes a VRM 1.0 by the
// names of its nodes. Exit 1 when a bone is more than 1 mm from its place; 77 when
// three-vrm is not installed.
const LIMIT_MM = 1;

let three;
let vrm;
let animation;
let judge;
try {
  three = await import('three');
  vrm = await import('@pixiv/three-vrm');
  animation = await import('@pixiv/three-vrm-animation');
  judge = await import('./joint_places.mjs');
} catch {
  console.log('skipped: three-vrm is missing; run `npm ci` in tests/tools');
  process.exit(77);
}

/// Makes a VRM of a body whose nodes are named like VRM's bones. Leaves out its look.
function asVrm(glb) {
  const { json } = glb;
  delete json.animations;
  if (json.extensions?.VRM) {
    const { meta, humanoid, specVersion, exporterVersion } = json.extensions.VRM;
    delete meta.texture;
    json.extensions = { VRM: { meta, humanoid, specVersion, exporterVersion } };
    return glb;
  }
  const humanBones = {};
  json.nodes.forEach(({ name }, node) => {
    if (Object.values(vrm.VRMHumanBoneName).includes(name)) humanBones[name] = { node };
  });
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

const [path, avatarPath, table] = process.argv.slice(2);
const frames = await judge.readPlaces(table);
const body = await judge.loadGltf(
  asVrm(await judge.readGlb(avatarPath)),
  (parser) => new vrm.VRMLoaderPlugin(parser),
);
const avatar = body.userData.vrm;
const [motion] = (
  await judge.loadGltf(
    await judge.readGlb(path),
    (parser) => new animation.VRMAnimationLoaderPlugin(parser),
  )
).userData.vrmAnimations;
const clip = animation.createVRMAnimationClip(motion, avatar);
const times = judge.keyTimes(clip, frames);
for (const { name } of clip.tracks) {
  if (name.endsWith('.scale')) throw new Error('bones are scaled');
}
if (motion.humanoidTracks.translation.size !== 1) throw new Error('more than the hips move');

// A VRM 0.x faces back; the places are of one that was turned round.
vrm.VRMUtils.rotateVRM0(avatar);
const mixer = new three.AnimationMixer(avatar.scene);
const action = mixer.clipAction(clip);
action.setLoop(three.LoopOnce);
action.clampWhenFinished = true;
action.play();
const pose = (frame) => {
  action.time = times[frame];
  mixer.update(0);
  avatar.humanoid.update();
  avatar.scene.updateMatrixWorld(true);
};
const bone = (name) => avatar.humanoid.getRawBoneNode(name);
const largest = judge.largestDistance(frames, bone, pose);
console.log(`${path} on ${avatarPath}: largest distance ${largest.toFixed(5)} mm`);
process.exit(largest <= LIMIT_MM ? 0 : 1);
