// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Cameras of a report as cameras of a scene, and how its scenes are drawn.

import {Matrix4, Quaternion, Vector3} from 'three';
import type {CameraWords} from '../protocol/protocol';
import {drawingOfBrowser} from '../scene/renderer';
import type {Drawing, Renderer} from '../scene/renderer';
import {requested} from './common';
import type {ReportCamera} from './data';

export function cameraWords(camera: ReportCamera): CameraWords {
  const {name, width_px, height_px, focal_px: [fx, fy], centre_px: [cx, cy], rms_px} = camera;
  const axes = [camera.right_in_world, camera.down_in_world, camera.forward_in_world]
    .map((axis) => new Vector3(...axis));
  const q = new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(axes[0], axes[1],
    axes[2])).toArray();
  return {name, width_px, height_px, fx, fy, cx, cy, rms_px,
    world_from_camera: {p: camera.centre_in_world_m, q}};
}

export function reportDrawing(): Drawing {
  return requested.includes('lines') ? 'lines' : drawingOfBrowser();
}

/** Returns what a picture consists of, for tests. Valid right after it was drawn. */
export function drawnStatus(renderer: Renderer): {drawing: string; colours: string} {
  const pixels = renderer.pixels();
  const seen = new Set<number>();
  for (let i = 0; i < pixels.length; i += 4) {
    seen.add((pixels[i] << 16) | (pixels[i + 1] << 8) | pixels[i + 2]);
  }
  return {drawing: renderer.options.drawing === 'lines' ? 'lines' : 'shaded',
    colours: String(seen.size)};
}
