// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// A body that walks on the spot, for the mock server: 25 joints, some of them uncertain.

const BONES = [
  ['hips', '', 0, 0.96, 0], ['spine', 'hips', 0, 0.1, 0], ['chest', 'spine', 0, 0.13, 0],
  ['upperChest', 'chest', 0, 0.13, 0], ['neck', 'upperChest', 0, 0.13, 0],
  ['head', 'neck', 0, 0.09, 0], ['headTop', 'head', 0, 0.19, 0],
];
for (const [side, s] of [['left', 1], ['right', -1]]) {
  BONES.push(
    [`${side}Shoulder`, 'upperChest', 0.03 * s, 0.08, 0],
    [`${side}UpperArm`, `${side}Shoulder`, 0.14 * s, 0, 0],
    [`${side}LowerArm`, `${side}UpperArm`, 0.28 * s, 0, 0],
    [`${side}Hand`, `${side}LowerArm`, 0.25 * s, 0, 0],
    [`${side}HandTip`, `${side}Hand`, 0.17 * s, 0, 0],
    [`${side}UpperLeg`, 'hips', 0.09 * s, -0.04, 0],
    [`${side}LowerLeg`, `${side}UpperLeg`, 0, -0.42, 0],
    [`${side}Foot`, `${side}LowerLeg`, 0, -0.42, 0],
    [`${side}Toes`, `${side}Foot`, 0, -0.06, 0.14]);
}

/** Joints in the order of a scene, parents first; the rest pose is a T-pose. */
export const JOINTS = BONES.map(([name, parent, x, y, z]) => ({
  name,
  parent: BONES.findIndex(([other]) => other === parent),
  bone: /Tip|Top/.test(name) ? '' : name,
  rest: {p: [x, y, z], q: [0, 0, 0, 1]},
}));

const about = (axis, angle) => {
  const q = [0, 0, 0, Math.cos(angle / 2)];
  q[axis] = Math.sin(angle / 2);
  return q;
};
const times = (a, b) => [
  a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
  a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
  a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
  a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]];

/** Rotations at this time, x y z w per joint. `droop`: angle by which the arms of the rest
 *  pose hang below a T-pose. [rad] */
export function postureAt(time_s, droop = 0) {
  const swing = Math.sin(2 * Math.PI * 0.9 * time_s);
  return JOINTS.map(({name}) => {
    const s = name.startsWith('left') ? 1 : -1;
    if (name.endsWith('UpperLeg')) return about(0, -0.45 * s * swing);
    if (name.endsWith('LowerLeg')) return about(0, 0.35 - 0.35 * s * Math.cos(5.65 * time_s));
    if (name.endsWith('UpperArm')) return times(about(0, 0.5 * s * swing),
      about(2, (droop - 1.25) * s));
    if (name.endsWith('LowerArm')) {
      return times(times(about(2, -droop * s), about(1, -0.4 * s)), about(2, droop * s));
    }
    if (name === 'spine') return about(1, 0.12 * swing);
    if (name === 'hips') return about(1, -0.1 * swing);
    return [0, 0, 0, 1];
  });
}

/** 0 measured, 1 repaired, 2 inferred. */
export function sourceAt(joint, frame) {
  const {name} = JOINTS[joint];
  if (/Tip|Top|Toes/.test(name)) return 2;
  if (name === 'leftLowerArm' && frame % 120 < 25) return 1;
  if (name === 'rightHand' && frame % 200 > 150) return frame % 200 > 175 ? 2 : 1;
  return 0;
}

/** The binary frame (kind 1) of these skeletons: all walk, each a little later. */
export function encodeFrame(skeletons, frame, time_s, sent_s) {
  const J = JOINTS.length;
  const padded = (J + 3) & ~3;
  const each = 4 + 12 + 16 * J;
  // None in flight.
  const isDown = frame % 60 < 54;
  const total = 24 + skeletons.reduce((sum, {estimate, balance, tracking}) => sum + each +
    (estimate ? 4 * J + padded : 0) + (balance ? 16 + 8 * 4 + (isDown ? 8 : 0) : 0) + (tracking ? 8 : 0), 0);
  const out = Buffer.alloc(total);
  out.writeUInt8(1, 0);
  out.writeUInt8(1, 1);
  out.writeUInt16LE(skeletons.length, 2);
  out.writeUInt32LE(frame, 4);
  out.writeDoubleLE(time_s, 8);
  out.writeDoubleLE(sent_s, 16);
  let at = 24;
  const float = (value) => { at = out.writeFloatLE(value, at); };
  skeletons.forEach(({estimate, balance, tracking, raise = 0, droop = 0}, k) => {
    out.writeUInt8(1 + (estimate ? 2 : 0) + (balance ? 4 : 0) + (tracking ? 8 : 0) +
      (balance && isDown ? 16 : 0), at);
    out.writeUInt16LE(J, at + 2);
    at += 4;
    const time = time_s - 0.1 * k;
    const sway = 0.03 * Math.sin(5.65 * time);
    [sway, 0.93 + 0.015 * Math.cos(11.3 * time) + raise, 0].forEach(float);
    postureAt(time, droop).flat().forEach(float);
    if (estimate) {
      for (let i = 0; i < J; ++i) float(0.006 + 0.02 * sourceAt(i, frame));
      for (let i = 0; i < J; ++i) out.writeUInt8(sourceAt(i, frame), at + i);
      at += padded;
    }
    if (balance) {
      [sway, 0.98, 0.02].forEach(float);
      at = out.writeUInt16LE(4, at) + 2;
      [-0.15, -0.12, 0.15, -0.12, 0.15, 0.18, -0.15, 0.18].forEach(float);
      if (isDown) [3 * sway, 0.03 + 0.2 * Math.sin(3.1 * time)].forEach(float);
    }
    if (tracking) {
      float(0.4 + 0.1 * Math.sin(frame / 9));
      // One foot, then the other.
      out.writeUInt8(frame % 33 < 18 ? 3 : 12, at);
      at += 4;
    }
  });
  return out;
}
