// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The eye: a camera that orbits a target with OrbitControls, and glides to views.

import {MathUtils, MOUSE, PerspectiveCamera, Vector3} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import type {Vector} from '../protocol/protocol';

/** Vertical angle of view. [rad] */
export const VIEW_ANGLE = 0.62;

export interface View {
  target_in_world: Vector; distance_m: number;
  /** Angle about Y, from +Z towards +X. [rad] */
  azimuth: number;
  /** Angle above the horizon. [rad] */
  height: number;
}

const FLESH_M = 0.22;

export class Orbit {
  readonly camera = new PerspectiveCamera(VIEW_ANGLE * MathUtils.RAD2DEG, 1, 0.05, 120);
  readonly controls: OrbitControls;
  /** The user has moved the eye since the last goTo(). */
  touched = false;
  /** Start and end of the current motion; the user's input cancels it. */
  private goal: View | null = null;
  private passed: View | null = null;

  /** `scrolled`: the canvas is part of a page that scrolls; the wheel zooms only after a click
   *  on it. */
  constructor(private readonly canvas: HTMLElement | null = null, changed = (): void => {},
    scrolled = false) {
    this.controls = Object.assign(new OrbitControls(this.camera, canvas), {minDistance: 0.3,
      maxDistance: 60, minPolarAngle: 0.02, maxPolarAngle: Math.PI / 2 + 0.1,
      mouseButtons: {LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.PAN, RIGHT: MOUSE.PAN}});
    this.place({target_in_world: [0, 0.9, 0], distance_m: 4.2, azimuth: 0.55, height: 0.2});
    this.controls.addEventListener('start', () => this.touch());
    this.controls.addEventListener('change', changed);
    if (scrolled && canvas) this.letScroll(canvas);
  }

  get distance_m(): number {
    return this.controls.getDistance();
  }

  get azimuth(): number {
    return this.controls.getAzimuthalAngle();
  }

  get height(): number {
    return Math.PI / 2 - this.controls.getPolarAngle();
  }

  get target(): Vector3 {
    return this.controls.target;
  }

  /** Sets the shape of the picture, width over height. */
  set aspect(aspect: number) {
    this.camera.aspect = aspect;
  }

  zoom(factor: number): void {
    this.touch();
    this.controls.dollyIn(factor);
  }

  turn(left_rad: number, up_rad: number): void {
    this.touch();
    this.controls.rotateLeft(left_rad);
    this.controls.rotateUp(up_rad);
  }

  /** Moves there in a few steps of glide(); at once if reduced motion is set. */
  goTo(view: View, atOnce: boolean): void {
    const {azimuth, height, distance_m} = this;
    this.touched = false;
    this.passed = {target_in_world: this.target.toArray(), distance_m, azimuth, height};
    // Rotate the shorter way.
    const turns = Math.round((azimuth - view.azimuth) / (2 * Math.PI));
    this.goal = {...view, azimuth: view.azimuth + 2 * Math.PI * turns};
    if (atOnce) this.glide(Infinity);
  }

  /** Advances the motion; returns true while it continues. */
  glide(seconds: number): boolean {
    const {goal, passed} = this;
    if (!goal || !passed) return false;
    const share = 1 - Math.exp(-9 * seconds);
    const {lerp} = MathUtils;
    const at: View = {
      target_in_world: passed.target_in_world.map((v, k) =>
        lerp(v, goal.target_in_world[k], share)) as Vector,
      distance_m: passed.distance_m * (goal.distance_m / passed.distance_m) ** share,
      azimuth: lerp(passed.azimuth, goal.azimuth, share),
      height: lerp(passed.height, goal.height, share),
    };
    const left = Math.abs(goal.azimuth - at.azimuth) + Math.abs(goal.height - at.height) +
      Math.abs(Math.log(goal.distance_m / at.distance_m)) +
      Math.hypot(...goal.target_in_world.map((v, k) => v - at.target_in_world[k]));
    if (left < 0.004) this.goal = null;
    this.passed = at;
    this.place(at);
    return true;
  }

  /** Moves the eye with the followed body. */
  shift(dx_m: number, dz_m: number): void {
    if (dx_m === 0 && dz_m === 0) return;
    for (const view of this.goal ? [this.goal, this.passed!] : []) {
      view.target_in_world[0] += dx_m;
      view.target_in_world[2] += dz_m;
    }
    const moved = new Vector3(dx_m, 0, dz_m);
    this.target.add(moved);
    this.camera.position.add(moved);
    this.controls.update();
  }

  private touch(): void {
    this.goal = null;
    this.touched = true;
  }

  private place({target_in_world, distance_m, azimuth, height}: View): void {
    this.target.set(...target_in_world);
    this.camera.position.setFromSphericalCoords(distance_m, Math.PI / 2 - height, azimuth)
      .add(this.target);
    this.controls.update();
  }

  private letScroll(canvas: HTMLElement): void {
    canvas.style.touchAction = 'pan-y';
    const allow = (zoom: boolean): void => { this.controls.enableZoom = zoom; };
    canvas.addEventListener('pointerdown', () => allow(true), true);
    canvas.addEventListener('wheel', (event) =>
      allow(document.activeElement === this.canvas || event.ctrlKey), {capture: true, passive: true});
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
