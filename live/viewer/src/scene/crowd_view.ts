// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Bones of many bodies as one mesh, and their shadows as another. Software renderers draw each
// instance of an instanced mesh on its own, so that forty bodies of them are too slow.

import {
  BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, Group, Mesh, MeshBasicMaterial,
  MeshLambertMaterial,
} from 'three';
import {boneMatrix, flatten} from './bone_shapes';
import type {Theme} from '../base/theme';
import type {Pose} from './posed_skeleton';
import type {Vector} from '../protocol/protocol';

/** An octahedron along y from 0 to 1, radius 1 at its widest place. */
const CORNERS = [[0, 0, 0], [1, 0.2, 0], [0, 0.2, -1], [-1, 0.2, 0], [0, 0.2, 1], [0, 1, 0]];
const FACES = [[0, 2, 1], [0, 3, 2], [0, 4, 3], [0, 1, 4], [5, 1, 2], [5, 2, 3], [5, 3, 4],
  [5, 4, 1]];
const SHADOW_WIDTH = 1.5;
const SHADOW_RIM_M = 0.006;

/** Bones of one body in the crowd. */
interface Bones {pose: Pose; offset: Vector; ends: number[]; radii: number[]; first: number}

export class CrowdView {
  readonly object = new Group();
  private readonly bodies: Bones[];
  private readonly bones: Mesh<BufferGeometry, MeshLambertMaterial>;
  private readonly shadow: Mesh<BufferGeometry, MeshBasicMaterial>;
  private readonly matrix = new Float32Array(16);

  constructor(bodies: readonly {pose: Pose; offset_m: Vector}[]) {
    let count = 0;
    this.bodies = bodies.map(({pose, offset_m}) => {
      const ends = [...pose.parents.keys()].filter((i) => pose.parents[i] >= 0);
      const first = count;
      count += ends.length;
      return {pose, offset: offset_m, ends, radii: radiiOf(pose, ends), first};
    });
    this.bones = mesh(count, new MeshLambertMaterial({flatShading: true}));
    this.shadow = mesh(count, new MeshBasicMaterial({side: DoubleSide, depthWrite: false}));
    this.shadow.renderOrder = -5;
    this.object.add(this.shadow, this.bones);
  }

  paint(theme: Theme): void {
    this.bones.material.color.setStyle(theme.colour('avatar'));
    this.shadow.material.color.setStyle(theme.colour('stage-shadow'));
  }

  /** Draws the current pose of a body; `isPresent` false: nothing. */
  update(body: number, isPresent: boolean, floor_m: number): void {
    const {pose, offset: [dx, dy, dz], ends, radii, first} = this.bodies[body];
    const {matrix} = this;
    const p = pose.p_in_world;
    ends.forEach((joint, k) => {
      const [a, b] = [3 * pose.parents[joint], 3 * joint];
      if (isPresent) boneMatrix(matrix, 0, p, a, b, radii[k], dx, dy, dz);
      else matrix.fill(0);
      write(this.bones.geometry, first + k, matrix);
      if (isPresent) {
        boneMatrix(matrix, 0, p, a, b, SHADOW_WIDTH * radii[k] + SHADOW_RIM_M, dx, dy, dz);
        flatten(matrix, 0, floor_m);
      }
      write(this.shadow.geometry, first + k, matrix);
    });
    for (const {geometry} of [this.bones, this.shadow]) {
      geometry.attributes.position.needsUpdate = true;
    }
  }

  dispose(): void {
    this.object.removeFromParent();
    for (const {geometry, material} of [this.bones, this.shadow]) {
      geometry.dispose();
      material.dispose();
    }
  }
}

function mesh<M extends MeshLambertMaterial | MeshBasicMaterial>(bones: number, material: M):
  Mesh<BufferGeometry, M> {
  const geometry = new BufferGeometry();
  const places = new BufferAttribute(new Float32Array(3 * CORNERS.length * bones), 3);
  places.setUsage(DynamicDrawUsage);
  geometry.setAttribute('position', places);
  geometry.setIndex(Array.from({length: bones}, (_, k) =>
    FACES.flat().map((corner) => CORNERS.length * k + corner)).flat());
  const made = new Mesh(geometry, material);
  made.frustumCulled = false;
  return made;
}

/** Writes the corners of bone k, transformed by the column-major matrix. */
function write({attributes: {position}}: BufferGeometry, k: number, m: Float32Array): void {
  const out = position.array as Float32Array;
  let at = 3 * CORNERS.length * k;
  for (const [x, y, z] of CORNERS) {
    out[at++] = m[0] * x + m[4] * y + m[8] * z + m[12];
    out[at++] = m[1] * x + m[5] * y + m[9] * z + m[13];
    out[at++] = m[2] * x + m[6] * y + m[10] * z + m[14];
  }
}

/** Radii of the bones at rest: a share of their length, limited by that of the body. [m] */
function radiiOf({p_in_world: p, parents}: Pose, ends: readonly number[]): number[] {
  let [low, high] = [Infinity, -Infinity];
  for (let i = 1; i < p.length; i += 3) [low, high] = [Math.min(low, p[i]), Math.max(high, p[i])];
  const thickest = 0.03 * Math.max(high - low, 0.2);
  return ends.map((joint) => {
    const [a, b] = [3 * parents[joint], 3 * joint];
    return Math.min(0.16 * Math.hypot(p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]),
      thickest);
  });
}
