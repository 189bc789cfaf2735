// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Drawing of a skeleton: bones in the colour of their source, uncertainty as balls, a shadow
// on the floor.

import {
  Color, DoubleSide, DynamicDrawUsage, Group, InstancedMesh, MeshBasicMaterial,
  MeshLambertMaterial, MeshStandardMaterial,
} from 'three';
import type {BufferGeometry, Material} from 'three';
import {ballGeometry, ballMatrix, boneGeometry, boneMatrix, flatten, girthOf, tubeGeometry} from
  './bone_shapes';
import type {SkeletonFrame} from '../protocol/decode_frame';
import type {Pose} from './posed_skeleton';
import {SOURCES} from '../protocol/protocol';
import type {Vector} from '../protocol/protocol';
import {scaleColour} from '../base/theme';
import type {Theme} from '../base/theme';

/** Quantity that the colours of a skeleton show. */
export type Colouring = 'source' | 'uncertainty' | 'plain';

/** Sigma at the end of the colour scale. */
export const SCALE_END_M = 0.03;
const SIGMAS = 2; // A ball of two sigma contains most position errors of a joint.
const LARGEST_BALL_M = 0.3;

export class SkeletonView {
  readonly object = new Group();
  private readonly pose: Pose;
  private readonly offset: Vector;
  /** Joint at the far end of every bone. */
  private readonly ends: number[];
  private readonly radii: number[];
  private readonly jointRadii: Float32Array;
  private readonly bones: InstancedMesh<BufferGeometry, Material>;
  private readonly balls: InstancedMesh<BufferGeometry, Material>;
  private readonly uncertainty: InstancedMesh<BufferGeometry, MeshBasicMaterial>;
  private readonly shadow: InstancedMesh<BufferGeometry, MeshBasicMaterial>;
  private readonly sourceColours = [new Color(), new Color(), new Color()];
  private readonly plain = new Color();
  private readonly performer: boolean;
  private readonly shadowWidth: number;
  private colouring: Colouring = 'source';
  private readonly scaled = new Color();

  /** `solid`: names of the joints' bones of a body that is drawn as a mannequin. `fleshed`: the
   *  bones are seen through a skin. `isGhost`: translucent and without shadow. */
  constructor(pose: Pose, offset: Vector, performer: boolean, fleshed: boolean,
    solid: readonly string[] | null = null, private readonly isGhost = false) {
    this.pose = pose;
    this.offset = offset;
    this.performer = performer;
    this.ends = [...pose.parents.keys()].filter((i) => pose.parents[i] >= 0);
    const lengths = this.ends.map((i) => restLength(pose, i));
    const size = stature(pose);
    this.radii = lengths.map((length, k) => (solid
      ? size * girthOf(solid[this.ends[k]], solid[pose.parents[this.ends[k]]])
      : Math.min(0.13 * length, 0.022 * size)));
    this.jointRadii = new Float32Array(pose.joints).fill(solid ? 0.01 * size : 0.0095 * size);
    // Joints of a mannequin close its tubes.
    if (solid) this.ends.forEach((end, k) => [end, pose.parents[end]].forEach((joint) => {
      this.jointRadii[joint] = Math.max(this.jointRadii[joint], this.radii[k]);
    }));
    const shape = solid ? tubeGeometry() : boneGeometry();
    const skin = solid ? new MeshStandardMaterial({roughness: 0.5}) : new MeshLambertMaterial();
    this.bones = instances(shape, skin, this.ends.length);
    this.balls = instances(ballGeometry(solid ? 3 : 0), skin, pose.joints);
    this.uncertainty = instances(ballGeometry(1), new MeshBasicMaterial({transparent: true, opacity: 0.28,
      depthWrite: false}), pose.joints);
    this.shadow = instances(shape, new MeshBasicMaterial({side: DoubleSide,
      depthWrite: false}), this.ends.length);
    this.bones.userData.long = true;
    this.shadow.userData.long = true;
    this.shadow.renderOrder = -5;
    this.uncertainty.renderOrder = 5;
    this.shadowWidth = solid ? 1 : fleshed ? 3.2 : 1.5;
    if (fleshed) {
      // Visible through the skin.
      skin.depthTest = false;
      this.bones.renderOrder = 3;
      this.balls.renderOrder = 3;
    }
    // Where nothing was changed, the ghost coincides with the body and is hidden by it.
    if (isGhost) Object.assign(skin, {transparent: true, opacity: 0.4, polygonOffset: true,
      polygonOffsetFactor: 4, polygonOffsetUnits: 4});
    this.object.add(this.shadow, this.bones, this.balls, this.uncertainty);
  }

  paint(theme: Theme): void {
    SOURCES.forEach((source, i) => this.sourceColours[i].setStyle(theme.colour(source)));
    this.plain.setStyle(theme.colour(
      this.isGhost ? 'quiet' : this.performer ? 'subject' : 'avatar'));
    this.shadow.material.color.setStyle(theme.colour('stage-shadow'));
  }

  show(bones: boolean, uncertainty: boolean, colouring: Colouring): void {
    this.colouring = colouring;
    this.bones.visible = bones;
    this.balls.visible = bones;
    this.uncertainty.visible = uncertainty && !this.isGhost;
    this.shadow.visible = !this.isGhost;
  }

  /** Draws the current pose. */
  update(frame: SkeletonFrame, floor_m: number): void {
    const {pose, ends} = this;
    const [dx, dy, dz] = this.offset;
    const p = pose.p_in_world;
    const isUncertain = frame.hasUncertainty;
    for (let k = 0; k < ends.length; ++k) {
      const joint = ends[k];
      const parent = pose.parents[joint];
      boneMatrix(this.bones.instanceMatrix.array as Float32Array, k, p, 3 * parent, 3 * joint,
        this.radii[k], dx, dy, dz);
      boneMatrix(this.shadow.instanceMatrix.array as Float32Array, k, p, 3 * parent,
        3 * joint, this.shadowWidth * this.radii[k] + 0.006, dx, dy, dz);
      flatten(this.shadow.instanceMatrix.array as Float32Array, k, floor_m);
      // A bone is named after the joint at its near end.
      this.bones.setColorAt(k, this.colour(frame, parent));
    }
    for (let i = 0; i < pose.joints; ++i) {
      ballMatrix(this.balls.instanceMatrix.array as Float32Array, i, p, 3 * i,
        this.jointRadii[i], dx, dy, dz);
      const colour = this.colour(frame, i);
      this.balls.setColorAt(i, colour);
      if (!this.uncertainty.visible) continue;
      ballMatrix(this.uncertainty.instanceMatrix.array as Float32Array, i, p, 3 * i,
        isUncertain ? Math.min(SIGMAS * frame.sigma_m[i], LARGEST_BALL_M) : 0, dx, dy, dz);
      this.uncertainty.setColorAt(i, colour);
    }
    for (const mesh of [this.bones, this.balls, this.uncertainty, this.shadow]) {
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
  }

  private colour(frame: SkeletonFrame, joint: number): Color {
    if (!frame.hasUncertainty || this.colouring === 'plain') return this.plain;
    return this.colouring === 'source' ? this.sourceColours[frame.source[joint]]
      : this.scaled.setStyle(scaleColour(frame.sigma_m[joint] / SCALE_END_M));
  }

  dispose(): void {
    for (const mesh of [this.bones, this.balls, this.uncertainty, this.shadow]) {
      mesh.geometry.dispose();
      mesh.material.dispose();
      mesh.dispose();
    }
  }
}

function instances<M extends Material>(shape: BufferGeometry, material: M, count: number):
  InstancedMesh<BufferGeometry, M> {
  const mesh = new InstancedMesh(shape, material, Math.max(count, 1));
  mesh.count = count;
  mesh.instanceMatrix.setUsage(DynamicDrawUsage);
  mesh.frustumCulled = false;
  return mesh;
}

function restLength(pose: Pose, joint: number): number {
  const p = pose.p_in_world;
  const [a, b] = [3 * pose.parents[joint], 3 * joint];
  return Math.hypot(p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]);
}

/** Returns the height from the lowest to the highest joint at rest. [m] */
function stature(pose: Pose): number {
  let low = Infinity;
  let high = -Infinity;
  for (let i = 0; i < pose.joints; ++i) {
    low = Math.min(low, pose.p_in_world[3 * i + 1]);
    high = Math.max(high, pose.p_in_world[3 * i + 1]);
  }
  return Math.max(high - low, 0.2);
}
