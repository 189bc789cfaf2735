// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Camera positions, their fields of view, and the positions of the board or wand.

import {BufferGeometry, Float32BufferAttribute, LineBasicMaterial, LineSegments} from 'three';
import {button, checkbox, el} from '../base/elements';
import {Theme} from '../base/theme';
import {listenToKeys} from '../panels/help';
import type {Vector} from '../protocol/protocol';
import {Stage} from '../scene/stage';
import {lead} from './common';
import type {CalibratedCamera, RigData, RigFigures} from './data';
import {cameraWords, reportDrawing} from './report_cameras';

const AZIMUTH = 0.6;
const HEIGHT = 0.5;
const CIRCLE = 32; // Lines of a circle.

/** Returns the word for the calibration target. */
export function shownTarget({target}: RigFigures): 'wand' | 'board' {
  return target.startsWith('wand') ? 'wand' : 'board';
}

/** Returns the lower Cholesky factor of a covariance. */
function cholesky(covariance: readonly (readonly number[])[]): number[][] {
  const l = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
  for (let i = 0; i < 3; ++i) {
    for (let k = 0; k <= i; ++k) {
      let rest = covariance[i][k];
      for (let j = 0; j < k; ++j) rest -= l[i][j] * l[k][j];
      if (i === k) l[i][i] = Math.sqrt(Math.max(rest, 0));
      else l[i][k] = l[k][k] > 1e-9 ? rest / l[k][k] : 0;
    }
  }
  return l;
}

/** Returns the lines of three great circles of the uncertainty of a camera's place, `scale`
 *  times too large: L u over unit circles u, with the covariance's Cholesky factor L. */
function sigmaCircles(camera: CalibratedCamera, scale: number): number[] {
  const l = cholesky(camera.centre_covariance_mm2);
  const at = (a: number, b: number, i: number): number[] => {
    const u = [0, 0, 0];
    u[a] = Math.cos(2 * Math.PI * i / CIRCLE);
    u[b] = Math.sin(2 * Math.PI * i / CIRCLE);
    return l.map((row, k) => camera.centre_in_world_m[k] +
      scale / 1000 * (row[0] * u[0] + row[1] * u[1] + row[2] * u[2]));
  };
  return [[0, 1], [1, 2], [2, 0]].flatMap(([a, b]) => Array.from({length: CIRCLE}, (_, i) =>
    [...at(a, b, i), ...at(a, b, i + 1)]).flat());
}

const loop = (corners: readonly Vector[]): number[] => corners.length < 2 ? []
  : corners.flatMap((p, i) => [...p, ...corners[(i + 1) % corners.length]]);

/** Returns three short lines through a place. */
const cross = (p: Vector, size: number): number[] => [0, 1, 2].flatMap((axis) => [-1, 1].flatMap(
  (way) => p.map((v, k) => (k === axis ? v + way * size : v))));

export class RigViewer {
  readonly root: HTMLElement;
  readonly stage: Stage;
  /** Enlargement of the drawn uncertainty. */
  readonly scale: number;
  private readonly theme = new Theme();
  private readonly parts: {colour: string; lines: LineSegments<BufferGeometry,
    LineBasicMaterial>}[] = [];

  constructor(private readonly data: RigData) {
    const {figures} = data;
    const {cameras, has_floor, distance_m} = figures;
    const size = Math.max(distance_m, 0.1);
    const sigma_mm = Math.max(1e-3, ...cameras.flatMap(({centre_covariance_mm2: c}) =>
      [0, 1, 2].map((i) => Math.sqrt(Math.max(c[i][i], 0)))));
    const room = 0.12 * size * 1000 / sigma_mm;
    this.scale = room < 1 ? 1 : 10 ** Math.floor(Math.log10(room));
    const target = shownTarget(figures);
    this.stage = new Stage(this.theme, {beforePicture: () => {}, afterPicture: () => {},
      reset: () => this.frame(), trouble: () => {}}, {drawing: reportDrawing(), scrolled: true,
      pyramid_m: 0.16 * size,
      label: `Three-dimensional view of the cameras and the ${target}. Drag to rotate, press ` +
        'plus and minus to zoom.'});
    this.stage.renderer.canvas.setAttribute('role', 'img');
    const height_m = has_floor ? 0
      // Without a known floor the grid is below everything.
      : Math.min(...this.places().map((p) => p[1])) - 0.05 * distance_m;
    this.stage.setScene({skeletons: [], cameras: cameras.map(cameraWords), points: null,
      floor: {height_m}, constraints: []});
    const places = [this.add('repaired', data.places.flatMap((corners) =>
      (corners.length > 1 ? loop(corners) : cross(corners[0], 0.012 * size)))),
    this.add('good', data.floor_places.flatMap((corners) => [...loop(corners),
      ...(corners.length < 4 ? [] : [...corners[0], ...corners[2], ...corners[1], ...corners[3]])]))];
    const uncertainty = [this.add('inferred', cameras.flatMap((c) => sigmaCircles(c, this.scale)))];
    const toggle = (label: string, lines: LineSegments[]): HTMLElement =>
      checkbox(label, true, (on) => {
        for (const line of lines) line.visible = on;
        this.stage.refresh();
      }, {class: 'toggle'});
    this.root = el('div', {class: 'viewer rig'}, this.stage.element,
      el('div', {class: 'controls'}, toggle(target === 'wand' ? 'Wand' : 'Board', places),
        toggle('Uncertainty', uncertainty), button({onclick: () => this.frame()}, 'Reset view'),
        el('span', {class: 'clock'}, 'Drag rotates, shift drag pans, the wheel zooms after a ' +
          'click into the picture.')));
    this.paint();
    this.theme.onChange(() => this.paint());
    this.listenToKeys();
  }

  private places(): Vector[] {
    const {figures, places, floor_places} = this.data;
    return [...places.flat(), ...floor_places.flat(),
      ...figures.cameras.map((camera) => camera.centre_in_world_m)];
  }

  private add(colour: string, ends: number[]): LineSegments {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new Float32BufferAttribute(ends, 3));
    const lines = new LineSegments(geometry, new LineBasicMaterial());
    lines.frustumCulled = false;
    this.stage.renderer.scene.add(lines);
    this.parts.push({colour, lines});
    return lines;
  }

  private paint(): void {
    for (const {colour, lines} of this.parts) {
      lines.material.color.setStyle(this.theme.colour(colour));
    }
    this.stage.refresh();
  }

  private frame(): void {
    this.stage.frame(this.places().flat(), AZIMUTH, HEIGHT, true);
  }

  private listenToKeys(): void {
    const {orbit} = this.stage;
    const turn = (left: number, up: number) => () => orbit.turn(0.1 * left, 0.07 * up);
    listenToKeys({ArrowLeft: turn(1, 0), ArrowRight: turn(-1, 0), ArrowUp: turn(0, 1),
      ArrowDown: turn(0, -1), '+': () => orbit.zoom(0.9), '-': () => orbit.zoom(1 / 0.9)},
    this.root);
  }
}

export function layoutSection(figures: RigFigures, {scale, root}: RigViewer): HTMLElement[] {
  const floor = figures.board_on_floor
    ? ' The green one, crossed out, is the board on the floor.'
    : figures.has_floor ? ' The grid is the floor.'
      : ' The floor was not detected: the grid is only for orientation.';
  return [
    lead('Check that the position and direction of every camera are as in the room. Orange ' +
      `outlines are places of the ${shownTarget(figures)}.${floor} Rings around a camera are ` +
      'the uncertainty of its position (one sigma), ' +
      (scale > 1 ? `enlarged ${scale} times.` : 'drawn to scale.')),
    root,
  ];
}
