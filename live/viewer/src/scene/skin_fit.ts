// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Mapping from the joints of a skeleton to the nodes of an avatar's file. The file may have
// other units, face the other way (VRM 0), and have its own axes in every joint.

import {multiply, multiplyInverse} from './quaternions';

/** Converts world rotations of joints to local rotations of nodes. */
export class NodeDriver {
  private readonly count: number;
  private readonly ancestors: Int16Array;
  /** before * (ancestor's joint)^-1 * (own joint) * after = the node's local rotation. */
  private readonly before: Float32Array;
  private readonly after: Float32Array;
  private readonly scratch = new Float32Array(4);

  /** At rest, x y z w each: the world rotations of joints and nodes (the file rotated into the
   *  scene's axes), and of the nodes' parents. `ancestors`: for each node, the nearest
   *  driven node above it; -1 for none. */
  constructor(joint_rest: Float32Array, node_rest: Float32Array, node_parent_rest: Float32Array,
    ancestors: Int16Array) {
    this.count = ancestors.length;
    this.ancestors = ancestors;
    this.before = new Float32Array(4 * this.count);
    this.after = new Float32Array(4 * this.count);
    const joint_from_parent = new Float32Array(4);
    const identity = new Float32Array([0, 0, 0, 1]);
    for (let i = 0; i < this.count; ++i) {
      multiplyInverse(this.after, 4 * i, joint_rest, 4 * i, node_rest, 4 * i);
      const above = ancestors[i];
      // Nodes between two driven nodes move with the upper one.
      if (above < 0) {
        joint_from_parent.set(node_parent_rest.subarray(4 * i, 4 * i + 4));
      } else {
        multiplyInverse(joint_from_parent, 0, joint_rest, 4 * above, node_parent_rest, 4 * i);
      }
      multiplyInverse(this.before, 4 * i, joint_from_parent, 0, identity, 0);
    }
  }

  /** Computes the local rotation of node i from the world rotations of the joints. */
  local(i: number, world_from_joint: Float32Array, out: Float32Array): void {
    const above = this.ancestors[i];
    const {scratch} = this;
    if (above < 0) {
      multiply(scratch, 0, this.before, 4 * i, world_from_joint, 4 * i);
    } else {
      multiplyInverse(scratch, 0, world_from_joint, 4 * above, world_from_joint, 4 * i);
      multiply(scratch, 0, this.before, 4 * i, scratch, 0);
    }
    multiply(out, 0, scratch, 0, this.after, 4 * i);
  }
}
