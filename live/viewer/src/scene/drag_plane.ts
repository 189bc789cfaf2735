// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Position of a dragged point: the pointer's ray meets a plane through the point where the
// drag began.

import type {Vector} from '../protocol/protocol';

const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** Returns the intersection of the ray and the plane through `on_plane` that faces the eye
 *  (`normal`); null if the ray is parallel to it or points away. */
export function dragInPlane(eye: Vector, ray: Vector, on_plane: Vector,
  normal: Vector): Vector | null {
  const slope = dot(ray, normal);
  if (Math.abs(slope) < 1e-6) return null;
  const reach = dot([on_plane[0] - eye[0], on_plane[1] - eye[1], on_plane[2] - eye[2]],
    normal) / slope;
  if (reach <= 0) return null;
  return [eye[0] + reach * ray[0], eye[1] + reach * ray[1], eye[2] + reach * ray[2]];
}

/** Returns the point of the vertical line through `start` nearest to the ray: x and z are
 *  kept. null if the ray is vertical. */
export function dragVertically(eye: Vector, ray: Vector, start: Vector): Vector | null {
  const level: Vector = [ray[0], 0, ray[2]];
  const length = Math.hypot(level[0], level[2]);
  if (length < 1e-3 * Math.hypot(...ray)) return null;
  const normal: Vector = [level[0] / length, 0, level[2] / length];
  const met = dragInPlane(eye, ray, start, normal);
  return met && [start[0], met[1], start[2]];
}
