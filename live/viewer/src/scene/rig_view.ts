// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The cameras, each with its viewing pyramid.

import {BufferGeometry, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments, Mesh,
  MeshLambertMaterial} from 'three';
import {turn} from './quaternions';
import {ballGeometry} from './bone_shapes';
import type {CameraWords, Vector} from '../protocol/protocol';
import type {Theme} from '../base/theme';

const DEPTH_M = 0.24;
const BODY = 0.09; // Radius of a camera, as a share of its pyramid's depth.

/** Returns the place in the world of a pixel at this depth. */
function pixelInWorld(camera: CameraWords, depth_m: number, x_px: number, y_px: number): Vector {
  const {p, q} = camera.world_from_camera;
  const in_camera = [depth_m * (x_px - camera.cx) / camera.fx,
    depth_m * (y_px - camera.cy) / camera.fy, depth_m];
  turn(in_camera, 0, q, 0, in_camera, 0);
  return [p[0] + in_camera[0], p[1] + in_camera[1], p[2] + in_camera[2]];
}

/** Returns the corners of a camera's picture, clockwise from the first pixel, in the world. */
export function frustumCorners(camera: CameraWords, depth_m = DEPTH_M): Vector[] {
  // Pixel centres are at integers.
  const [right, bottom] = [camera.width_px - 0.5, camera.height_px - 0.5];
  return [[-0.5, -0.5], [right, -0.5], [right, bottom], [-0.5, bottom]].map(([x, y]) =>
    pixelInWorld(camera, depth_m, x, y));
}

/** Returns the end points of the lines of a camera's pyramid, x y z each, in the world. A
 *  short stroke marks the top of its picture. */
export function frustumLines(camera: CameraWords, depth_m = DEPTH_M): number[] {
  const {world_from_camera: {p}, width_px, height_px} = camera;
  const corners = frustumCorners(camera, depth_m);
  const lines = corners.flatMap((at, i) => [...at, ...corners[(i + 1) % 4], ...p, ...at]);
  const top = [[0.35 * width_px, -0.5], [0.5 * width_px, -0.14 * height_px],
    [0.65 * width_px, -0.5]].map(([x, y]) => pixelInWorld(camera, depth_m, x, y));
  return [...lines, ...top[0], ...top[1], ...top[1], ...top[2]];
}

export class RigView {
  readonly object = new Group();
  private readonly lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial({
    transparent: true, opacity: 0.6}));
  private readonly skin = new MeshLambertMaterial();
  private readonly ball = ballGeometry(2);

  set(cameras: readonly CameraWords[], depth_m = DEPTH_M): void {
    this.lines.geometry.dispose();
    this.lines.geometry = new BufferGeometry();
    this.lines.geometry.setAttribute('position', new Float32BufferAttribute(
      cameras.flatMap((camera) => frustumLines(camera, depth_m)), 3));
    this.lines.frustumCulled = false;
    this.object.clear().add(this.lines, ...cameras.map(({world_from_camera: {p}}) => {
      const body = new Mesh(this.ball, this.skin);
      body.position.set(...p);
      body.scale.setScalar(BODY * depth_m);
      return body;
    }));
  }

  paint(theme: Theme): void {
    this.lines.material.color.setStyle(theme.colour('stage-line'));
    this.skin.color.setStyle(theme.colour('subject'));
  }
}
