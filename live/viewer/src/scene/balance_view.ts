// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Balance: the centre of mass, its vertical line, the support polygon, and the zero moment point.

import {
  BufferAttribute, BufferGeometry, CircleGeometry, Color, DoubleSide, DynamicDrawUsage, Group, Line,
  LineBasicMaterial, LineLoop, Mesh, MeshBasicMaterial, RingGeometry, SphereGeometry,
} from 'three';
import type {SkeletonFrame} from '../protocol/decode_frame';
import type {Vector} from '../protocol/protocol';
import type {Theme} from '../base/theme';

const MAX_CORNERS = 64;
const ABOVE_FLOOR_M = 0.004;

/** Returns true if a point on the floor is within a convex polygon (x z per corner, in
 *  either orientation). */
export function carries(corners_xz: ArrayLike<number>, corners: number, x: number,
  z: number): boolean {
  if (corners < 3) return false;
  let left = 0;
  let right = 0;
  for (let i = 0; i < corners; ++i) {
    const k = (i + 1) % corners;
    const ax = corners_xz[2 * i];
    const az = corners_xz[2 * i + 1];
    const side = (corners_xz[2 * k] - ax) * (z - az) - (corners_xz[2 * k + 1] - az) * (x - ax);
    if (side > 0) ++left;
    if (side < 0) ++right;
  }
  return left === 0 || right === 0;
}

export class BalanceView {
  readonly object = new Group();
  private readonly offset: Vector;
  private readonly corners = new BufferAttribute(new Float32Array(3 * MAX_CORNERS), 3);
  private readonly plumbEnds = new BufferAttribute(new Float32Array(6), 3);
  private readonly mark = new MeshBasicMaterial({depthTest: false});
  private readonly line = new LineBasicMaterial({depthTest: false, transparent: true,
    opacity: 0.8});
  private readonly fill = new MeshBasicMaterial({side: DoubleSide, transparent: true,
    opacity: 0.22, depthWrite: false});
  private readonly zmpMark = new MeshBasicMaterial({depthTest: false, side: DoubleSide,
    transparent: true});
  private readonly centre: Mesh;
  private readonly foot: Mesh;
  private readonly area: Mesh;
  private readonly outline: LineLoop;
  private readonly plumb: Line;
  /** A ring with a dot: the centre of mass is a ball. */
  private readonly zmp: Mesh;
  private readonly zmpDot: Mesh;
  private readonly good = new Color();
  private readonly poor = new Color();

  constructor(offset: Vector) {
    this.offset = offset;
    this.corners.setUsage(DynamicDrawUsage);
    this.plumbEnds.setUsage(DynamicDrawUsage);
    this.centre = new Mesh(new SphereGeometry(0.028, 12, 8), this.mark);
    this.foot = new Mesh(new SphereGeometry(0.014, 8, 6), this.mark);
    const fan = new BufferGeometry();
    fan.setAttribute('position', this.corners);
    fan.setIndex(Array.from({length: MAX_CORNERS - 2}, (_, i) => [0, i + 1, i + 2]).flat());
    this.area = new Mesh(fan, this.fill);
    const loop = new BufferGeometry();
    loop.setAttribute('position', this.corners);
    this.outline = new LineLoop(loop, this.line);
    const plumb = new BufferGeometry();
    plumb.setAttribute('position', this.plumbEnds);
    this.plumb = new Line(plumb, this.line);
    this.zmp = new Mesh(new RingGeometry(0.03, 0.044, 24), this.zmpMark);
    this.zmpDot = new Mesh(new CircleGeometry(0.013, 16), this.zmpMark);
    for (const part of [this.zmp, this.zmpDot]) part.rotation.x = -Math.PI / 2;
    this.object.add(this.area, this.outline, this.plumb, this.centre, this.foot, this.zmp,
      this.zmpDot);
    for (const part of this.object.children) {
      part.frustumCulled = false;
      part.renderOrder = 4;
    }
    this.area.renderOrder = -4;
    this.outline.renderOrder = -3;
  }

  paint(theme: Theme): void {
    this.good.setStyle(theme.colour('good'));
    this.poor.setStyle(theme.colour('poor'));
  }

  update(frame: SkeletonFrame, floor_m: number): void {
    const [dx, dy, dz] = this.offset;
    const [x, y, z] = frame.centre_of_mass_in_world;
    const corners = Math.min(frame.corners, MAX_CORNERS);
    const held = carries(frame.support_xz, corners, x, z);
    for (const material of [this.mark, this.line, this.fill]) {
      material.color.copy(held ? this.good : this.poor);
    }
    for (let i = 0; i < corners; ++i) {
      this.corners.setXYZ(i, frame.support_xz[2 * i] + dx, floor_m + ABOVE_FLOOR_M,
        frame.support_xz[2 * i + 1] + dz);
    }
    this.corners.needsUpdate = true;
    this.area.geometry.setDrawRange(0, 3 * Math.max(corners - 2, 0));
    this.outline.geometry.setDrawRange(0, corners);
    this.area.visible = corners > 2;
    this.outline.visible = corners > 1;
    this.plumbEnds.setXYZ(0, x + dx, y + dy, z + dz);
    this.plumbEnds.setXYZ(1, x + dx, floor_m + ABOVE_FLOOR_M, z + dz);
    this.plumbEnds.needsUpdate = true;
    this.centre.position.set(x + dx, y + dy, z + dz);
    this.foot.position.set(x + dx, floor_m + ABOVE_FLOOR_M, z + dz);
    this.updateZmp(frame, corners, floor_m);
  }

  /** Red outside of the polygon: the feet alone cannot bear the motion. */
  private updateZmp({hasZmp, zmp_xz: [x, z], support_xz}: SkeletonFrame, corners: number,
    floor_m: number): void {
    const [dx, , dz] = this.offset;
    this.zmp.visible = hasZmp;
    this.zmpDot.visible = hasZmp;
    if (!hasZmp) return;
    this.zmpMark.color.copy(carries(support_xz, corners, x, z) ? this.good : this.poor);
    for (const part of [this.zmp, this.zmpDot]) {
      part.position.set(x + dx, floor_m + ABOVE_FLOOR_M, z + dz);
    }
  }

  dispose(): void {
    for (const part of this.object.children) (part as Mesh).geometry.dispose();
    for (const material of [this.mark, this.line, this.fill, this.zmpMark]) material.dispose();
  }
}
