// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The eye that orbits a target. Independent of the screen: gestures.ts moves it.

import type {Vector} from './protocol';

/** Vertical angle of view. [rad] */
export const VIEW_ANGLE = 0.62;

export interface View {
  target_in_world: Vector;
  distance_m: number;
  /** Angle about Y, from +Z towards +X. [rad] */
  azimuth: number;
  /** Angle above the horizon. [rad] */
  height: number;
}

const NEAREST_M = 0.3;
const FARTHEST_M = 60;
const FLESH_M = 0.22;

export class Orbit implements View {
  target_in_world: Vector = [0, 0.9, 0];
  distance_m = 4.2;
  azimuth = 0.55;
  height = 0.2;
  /** Target of the current motion; the user's input cancels it. */
  private goal: View | null = null;

  eye(out: Vector): Vector {
    const flat = this.distance_m * Math.cos(this.height);
    out[0] = this.target_in_world[0] + flat * Math.sin(this.azimuth);
    out[1] = this.target_in_world[1] + this.distance_m * Math.sin(this.height);
    out[2] = this.target_in_world[2] + flat * Math.cos(this.azimuth);
    return out;
  }

  turn(dx_px: number, dy_px: number): void {
    this.goal = null;
    this.azimuth -= 0.008 * dx_px;
    this.height = Math.min(Math.max(this.height + 0.006 * dy_px, -0.1), 1.55);
  }

  zoom(factor: number): void {
    this.goal = null;
    this.distance_m = Math.min(Math.max(this.distance_m * factor, NEAREST_M), FARTHEST_M);
  }

  /** Pans, so that the target stays under the pointer. */
  pan(dx_px: number, dy_px: number, height_px: number): void {
    this.goal = null;
    const metres = 2 * this.distance_m * Math.tan(VIEW_ANGLE / 2) / Math.max(height_px, 1);
    const [sin, cos] = [Math.sin(this.azimuth), Math.cos(this.azimuth)];
    const up = Math.cos(this.height) * dy_px * metres;
    const away = Math.sin(this.height) * dy_px * metres;
    this.target_in_world[0] += -dx_px * metres * cos - away * sin;
    this.target_in_world[1] = Math.max(-1, this.target_in_world[1] + up);
    this.target_in_world[2] += dx_px * metres * sin - away * cos;
  }

  /** Moves there in a few steps of glide(); at once if reduced motion is set. */
  goTo(view: View, atOnce: boolean): void {
    // Rotate the shorter way.
    const turns = Math.round((this.azimuth - view.azimuth) / (2 * Math.PI));
    this.goal = {...view, azimuth: view.azimuth + 2 * Math.PI * turns};
    if (atOnce) this.glide(Infinity);
  }

  /** Advances the motion; returns true while it continues. */
  glide(seconds: number): boolean {
    const {goal} = this;
    if (!goal) return false;
    const share = 1 - Math.exp(-9 * seconds);
    for (let k = 0; k < 3; ++k) {
      this.target_in_world[k] += share * (goal.target_in_world[k] - this.target_in_world[k]);
    }
    this.distance_m *= (goal.distance_m / this.distance_m) ** share;
    this.azimuth += share * (goal.azimuth - this.azimuth);
    this.height += share * (goal.height - this.height);
    const left = Math.abs(goal.azimuth - this.azimuth) + Math.abs(goal.height - this.height) +
      Math.abs(Math.log(goal.distance_m / this.distance_m)) +
      Math.hypot(...goal.target_in_world.map((v, k) => v - this.target_in_world[k]));
    if (left < 0.004) this.goal = null;
    return true;
  }

  /** Moves the eye with the followed body. */
  shift(dx_m: number, dz_m: number): void {
    this.target_in_world[0] += dx_m;
    this.target_in_world[2] += dz_m;
    if (!this.goal) return;
    this.goal.target_in_world[0] += dx_m;
    this.goal.target_in_world[2] += dz_m;
  }
}

const LEASH_M = 0.25;

/** Returns the move of the eye for a followed body at offset (x, z) from its assumed place.
 *  Small steps do not move the eye. */
export function leash(x_m: number, z_m: number): [number, number] {
  const away = Math.hypot(x_m, z_m);
  const share = away > LEASH_M ? 1 - LEASH_M / away : 0;
  return [share * x_m, share * z_m];
}

/** Returns the view from this side that contains all finite points (x y z each), with a
 *  small margin; null without points. */
export function framing(points_in_world: ArrayLike<number>, azimuth: number, height: number,
  aspect: number): View | null {
  const [sin, cos] = [Math.sin(azimuth), Math.cos(azimuth)];
  const [rise, flat] = [Math.sin(height), Math.cos(height)];
  // Axes: right, up, and towards the eye.
  const axes = [[cos, 0, -sin], [-rise * sin, flat, -rise * cos], [flat * sin, rise, flat * cos]];
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  const along = (i: number, axis: number[]): number => axis[0] * points_in_world[i] +
    axis[1] * points_in_world[i + 1] + axis[2] * points_in_world[i + 2];
  for (let i = 0; i < points_in_world.length; i += 3) {
    axes.forEach((axis, k) => {
      const value = along(i, axis);
      if (!Number.isFinite(value)) return;
      low[k] = Math.min(low[k], value);
      high[k] = Math.max(high[k], value);
    });
  }
  if (!low.every(Number.isFinite)) return null;
  const middle = low.map((v, k) => (v + high[k]) / 2);
  const slope = Math.tan(VIEW_ANGLE / 2);
  let distance_m = 0;
  for (let i = 0; i < points_in_world.length; i += 3) {
    const [x, y, z] = axes.map((axis, k) => along(i, axis) - middle[k]);
    if (!Number.isFinite(x + y + z)) continue;
    distance_m = Math.max(distance_m, z + (Math.abs(y) + FLESH_M) / slope,
      z + (Math.abs(x) + FLESH_M) / (slope * aspect));
  }
  const target_in_world = [0, 1, 2].map((c) =>
    axes.reduce((sum, axis, k) => sum + axis[c] * middle[k], 0)) as Vector;
  return {target_in_world, distance_m, azimuth, height};
}
