// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The cameras, each with its viewing pyramid.

import {BufferGeometry, Float32BufferAttribute, LineBasicMaterial, LineSegments} from 'three';
import {turn} from './quaternions';
import type {CameraWords, Vector} from './protocol';
import type {Colours} from './theme';

const DEPTH_M = 0.24;

/** Returns the end points of the lines of a camera's pyramid, x y z each, in the world. A
 *  short stroke marks the top of its picture. */
export function frustumLines(camera: CameraWords): number[] {
  const {p, q} = camera.world_from_camera;
  const corner = (x_px: number, y_px: number): Vector => {
    const in_camera = [DEPTH_M * (x_px - camera.cx) / camera.fx,
      DEPTH_M * (y_px - camera.cy) / camera.fy, DEPTH_M];
    turn(in_camera, 0, q, 0, in_camera, 0);
    return [p[0] + in_camera[0], p[1] + in_camera[1], p[2] + in_camera[2]];
  };
  // Pixel centres are at integers.
  const [right, bottom] = [camera.width_px - 0.5, camera.height_px - 0.5];
  const corners = [corner(-0.5, -0.5), corner(right, -0.5), corner(right, bottom),
    corner(-0.5, bottom)];
  const lines = corners.flatMap((at, i) => [...at, ...corners[(i + 1) % 4], ...p, ...at]);
  const top = [corner(0.35 * right, -0.5), corner(0.5 * right, -0.14 * bottom),
    corner(0.65 * right, -0.5)];
  return [...lines, ...top[0], ...top[1], ...top[1], ...top[2]];
}

export class RigView {
  readonly object = new LineSegments(new BufferGeometry(), new LineBasicMaterial({
    transparent: true, opacity: 0.6}));

  set(cameras: readonly CameraWords[]): void {
    this.object.geometry.dispose();
    this.object.geometry = new BufferGeometry();
    this.object.geometry.setAttribute('position',
      new Float32BufferAttribute(cameras.flatMap(frustumLines), 3));
    this.object.frustumCulled = false;
  }

  paint(colours: Colours): void {
    this.object.material.color.setStyle(colours.line);
  }
}
