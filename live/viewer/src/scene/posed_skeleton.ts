// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Joint positions and rotations of a posed skeleton.

import type {SkeletonFrame} from '../protocol/decode_frame';
import type {SkeletonWords} from '../protocol/protocol';
import {blend, multiply, turn} from './quaternions';

/** Joint positions at one instant. */
export interface Pose {
  readonly joints: number;
  readonly parents: Int16Array;
  /** x y z of every joint, without the display offset of the skeleton. */
  readonly p_in_world: Float32Array;
  /** x y z w of every joint. */
  readonly world_from_joint: Float32Array;
  setFrame(frame: SkeletonFrame): void;
  /** Heading of the body: angle about Y from +Z, its heading at rest. [rad] */
  heading(): number;
}

export class PosedSkeleton implements Pose {
  readonly joints: number;
  readonly parents: Int16Array;
  readonly p_in_world: Float32Array;
  readonly world_from_joint: Float32Array;
  private readonly p_in_parent: Float32Array;
  private readonly world_from_root_rest: Float32Array;

  constructor(words: Pick<SkeletonWords, 'joints'>) {
    const {joints} = words;
    this.joints = joints.length;
    this.parents = Int16Array.from(joints, (joint) => joint.parent);
    this.p_in_parent = Float32Array.from(joints.flatMap((joint) => joint.rest.p));
    this.p_in_world = new Float32Array(3 * joints.length);
    this.world_from_joint = new Float32Array(4 * joints.length);
    this.setRest(words);
    this.world_from_root_rest = this.world_from_joint.slice(0, 4);
  }

  setRest(words: Pick<SkeletonWords, 'joints'>): void {
    const local = Float32Array.from(words.joints.flatMap((joint) => joint.rest.q));
    this.set(local, this.p_in_parent);
  }

  /** Computes all joints in one pass. Precondition: the frame has a pose of the same number
   *  of joints. */
  setFrame(frame: SkeletonFrame): void {
    this.set(frame.parent_from_joint, frame.root_in_world);
  }

  heading(): number {
    const ahead = [0, 0, 1];
    const {world_from_root_rest: rest} = this;
    turn(ahead, 0, [-rest[0], -rest[1], -rest[2], rest[3]], 0, ahead, 0);
    turn(ahead, 0, this.world_from_joint, 0, ahead, 0);
    return Math.atan2(ahead[0], ahead[2]);
  }

  private set(parent_from_joint: Float32Array, root_in_world: Float32Array): void {
    const {p_in_world: p, world_from_joint: q} = this;
    for (let i = 0; i < this.joints; ++i) {
      const parent = this.parents[i];
      if (parent < 0) {
        for (let k = 0; k < 3; ++k) p[3 * i + k] = root_in_world[k];
        for (let k = 0; k < 4; ++k) q[4 * i + k] = parent_from_joint[4 * i + k];
        continue;
      }
      turn(p, 3 * i, q, 4 * parent, this.p_in_parent, 3 * i);
      for (let k = 0; k < 3; ++k) p[3 * i + k] += p[3 * parent + k];
      multiply(q, 4 * i, q, 4 * parent, parent_from_joint, 4 * i);
    }
  }
}

/** Writes the instant between two frames to `into`: poses are interpolated, other values
 *  are the nearer frame's. If one frame has no pose, only the nearer frame is used. */
export function blendFrames(into: SkeletonFrame, a: SkeletonFrame, b: SkeletonFrame,
  share: number): void {
  into.copy(share < 0.5 ? a : b);
  if (!a.hasPose || !b.hasPose) return;
  for (let k = 0; k < 3; ++k) {
    into.root_in_world[k] = (1 - share) * a.root_in_world[k] + share * b.root_in_world[k];
  }
  for (let i = 0; i < into.joints; ++i) {
    blend(into.parent_from_joint, a.parent_from_joint, b.parent_from_joint, 4 * i, share);
  }
  if (!a.hasBalance || !b.hasBalance) return;
  for (let k = 0; k < 3; ++k) {
    into.centre_of_mass_in_world[k] = (1 - share) * a.centre_of_mass_in_world[k] +
      share * b.centre_of_mass_in_world[k];
  }
  if (!a.hasZmp || !b.hasZmp) return;
  for (let k = 0; k < 2; ++k) into.zmp_xz[k] = (1 - share) * a.zmp_xz[k] + share * b.zmp_xz[k];
}
