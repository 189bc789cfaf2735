// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The length of a body's legs, by which `retarget` scales.

import type {JointWords, Vector} from '../protocol/protocol';
import {turn} from '../scene/quaternions';

/** Place of joint i in joint `above` or its ancestors; null: `above` is none of its parents. */
function placeBelow(joints: readonly JointWords[], i: number, above: number): Vector | null {
  let at: Vector = [0, 0, 0];
  for (let j = i; j !== above; j = joints[j].parent) {
    if (j < 0) return null;
    const {p, q} = joints[j].rest;
    turn(at, 0, q, 0, at, 0);
    at = [at[0] + p[0], at[1] + p[1], at[2] + p[2]];
  }
  return at;
}

/** Mean length of thigh and shin of both legs; null: the body has no legs. */
export function legLength_m(joints: readonly JointWords[]): number | null {
  const length_m = (above: string, below: string): number | null => {
    const [i, j] = [above, below].map((name) => joints.findIndex(({bone}) => bone === name));
    const at = i < 0 || j < 0 ? null : placeBelow(joints, j, i);
    return at && Math.hypot(...at);
  };
  let sum = 0;
  for (const side of ['left', 'right']) {
    const thigh_m = length_m(`${side}UpperLeg`, `${side}LowerLeg`);
    const shin_m = length_m(`${side}LowerLeg`, `${side}Foot`);
    if (thigh_m === null || shin_m === null) return null;
    sum += thigh_m + shin_m;
  }
  return sum / 2;
}
