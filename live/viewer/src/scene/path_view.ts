// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The path of a body on the floor: a line with a mark each second, and points that can be
// dragged, with the curve through them.

import {
  BufferGeometry, CircleGeometry, Color, DynamicDrawUsage, Float32BufferAttribute, Group,
  InstancedMesh, Line, LineBasicMaterial, Matrix4, Mesh, MeshBasicMaterial, RingGeometry,
} from 'three';
import type {Vector} from '../protocol/protocol';
import type {Theme} from '../base/theme';
import {placeAt} from './floor_path';
import type {FloorPath} from './floor_path';
import type {StagePart} from './stage';

const ABOVE_FLOOR_M = 0.006;
const WIDTH_M = 0.014;
/** Size of points on the screen, as a share of the distance to the eye. */
const POINT_SIZE = 0.011;
const MAX_MARKS = 3600;
const MAX_POINTS = 256;

/** A band on the floor, and a line in it that is at least one pixel wide. */
class FloorLine {
  readonly object = new Group();
  readonly material: LineBasicMaterial;
  private readonly fill: MeshBasicMaterial;
  private readonly line: Line<BufferGeometry, LineBasicMaterial>;
  private readonly band: Mesh<BufferGeometry, MeshBasicMaterial>;

  constructor(order: number, opacity: number) {
    const look = {transparent: true, opacity, depthWrite: false};
    this.material = new LineBasicMaterial(look);
    this.fill = new MeshBasicMaterial({...look, side: 2});
    this.line = new Line(new BufferGeometry(), this.material);
    this.band = new Mesh(new BufferGeometry(), this.fill);
    this.object.add(this.band, this.line);
    for (const part of [this.band, this.line]) {
      part.frustumCulled = false;
      part.renderOrder = order;
    }
  }

  set(xz: ArrayLike<number>, y_m: number): void {
    const count = xz.length / 2;
    const middle = new Float32Array(3 * count);
    const sides = new Float32Array(6 * count);
    for (let k = 0; k < count; ++k) {
      const [before, after] = [Math.max(k - 1, 0), Math.min(k + 1, count - 1)];
      const dx = xz[2 * after] - xz[2 * before];
      const dz = xz[2 * after + 1] - xz[2 * before + 1];
      const share = WIDTH_M / 2 / Math.max(Math.hypot(dx, dz), 1e-9);
      const [x, z] = [xz[2 * k], xz[2 * k + 1]];
      middle.set([x, y_m, z], 3 * k);
      sides.set([x - share * dz, y_m, z + share * dx, x + share * dz, y_m, z - share * dx], 6 * k);
    }
    this.line.geometry.dispose();
    this.line.geometry = new BufferGeometry().setAttribute('position',
      new Float32BufferAttribute(middle, 3));
    this.band.geometry.dispose();
    const strip = new BufferGeometry().setAttribute('position',
      new Float32BufferAttribute(sides, 3));
    strip.setIndex(Array.from({length: Math.max(count - 1, 0)}, (_, k) => {
      const i = 2 * k;
      return [i, i + 1, i + 2, i + 2, i + 1, i + 3];
    }).flat());
    this.band.geometry = strip;
    this.object.visible = count > 1;
  }

  paint(colour: string): void {
    this.material.color.setStyle(colour);
    this.fill.color.setStyle(colour);
  }
}

export class PathView implements StagePart {
  readonly object = new Group();
  /** Points that can be dragged. [m] */
  points: readonly (readonly [number, number])[] = [];
  /** The point under the pointer or in hand, and the selected one; -1: none. */
  held = -1;
  selected = -1;
  private readonly way = new FloorLine(-4, 0.9);
  private readonly curve = new FloorLine(-3, 1);
  private readonly marks = discs(new CircleGeometry(1, 20), MAX_MARKS, -2);
  /** Squares, which are not mistaken for handles of the body. */
  private readonly rims = discs(new CircleGeometry(1.7, 4, Math.PI / 4), MAX_POINTS, 18);
  private readonly discs = discs(new CircleGeometry(1.25, 4, Math.PI / 4), MAX_POINTS, 19);
  private readonly now = new Mesh(new RingGeometry(0.05, 0.065, 28).rotateX(-Math.PI / 2),
    new MeshBasicMaterial({depthWrite: false, transparent: true}));
  private readonly matrix = new Matrix4();
  private readonly place: number[] = [0, 0];
  private readonly plain = new Color();
  private readonly bright = new Color();
  private path: FloorPath | null = null;
  private floor_m = 0;

  constructor() {
    this.now.renderOrder = -1;
    for (const points of [this.rims, this.discs]) {
      points.material.depthTest = false;
      points.material.transparent = true;
    }
    this.object.add(this.way.object, this.marks, this.curve.object, this.now, this.rims,
      this.discs);
    this.setPath(null, 30, 0);
    this.setPoints([], []);
  }

  /** Shows the path of a motion; null: none. */
  setPath(path: FloorPath | null, rate_hz: number, floor_m: number): void {
    this.path = path && path.xz.length >= 4 ? path : null;
    this.floor_m = floor_m;
    const shown = this.path;
    this.way.set(shown?.xz ?? [], floor_m + ABOVE_FLOOR_M);
    this.now.visible = shown !== null;
    let count = 0;
    for (let frame = 0; shown && frame < shown.frames && count < MAX_MARKS; frame += rate_hz) {
      placeAt(shown, frame, this.place);
      this.matrix.makeScale(0.026, 1, 0.026).setPosition(this.place[0],
        floor_m + ABOVE_FLOOR_M, this.place[1]);
      this.marks.setMatrixAt(count++, this.matrix);
    }
    this.marks.count = count;
    this.marks.instanceMatrix.needsUpdate = true;
  }

  /** Marks the place at this instant. [frames] */
  setTime(time: number): void {
    if (!this.path) return;
    placeAt(this.path, time, this.place);
    this.now.position.set(this.place[0], this.floor_m + ABOVE_FLOOR_M, this.place[1]);
  }

  /** Shows points, and the curve through them (x z each). */
  setPoints(points: readonly (readonly [number, number])[], curve_xz: ArrayLike<number>): void {
    this.points = points.slice(0, MAX_POINTS);
    this.curve.set(curve_xz, this.floor_m + 1.5 * ABOVE_FLOOR_M);
  }

  /** Place of a point in the world. */
  pointInWorld(i: number): Vector {
    return [this.points[i][0], this.floor_m + ABOVE_FLOOR_M, this.points[i][1]];
  }

  paint(theme: Theme): void {
    this.way.paint(theme.colour('stage-line'));
    this.marks.material.color.setStyle(theme.colour('stage-line'));
    this.curve.paint(theme.colour('accent'));
    this.now.material.color.setStyle(theme.colour('ink'));
    this.rims.material.color.setStyle(theme.colour('card'));
    this.plain.setStyle(theme.colour('accent'));
    this.bright.setStyle(theme.colour('ink'));
  }

  /** Gives the points a constant size on the screen. */
  update(eye: Vector): void {
    const y = this.floor_m + ABOVE_FLOOR_M;
    for (let i = 0; i < this.points.length; ++i) {
      const [x, z] = this.points[i];
      const away = Math.hypot(x - eye[0], y - eye[1], z - eye[2]);
      const size = POINT_SIZE * away * (i === this.held ? 1.35 : 1);
      this.matrix.makeScale(size, 1, size).setPosition(x, y, z);
      this.rims.setMatrixAt(i, this.matrix);
      this.discs.setMatrixAt(i, this.matrix);
      this.discs.setColorAt(i, i === this.held || i === this.selected ? this.bright : this.plain);
    }
    this.rims.count = this.points.length;
    this.discs.count = this.points.length;
    this.rims.instanceMatrix.needsUpdate = true;
    this.discs.instanceMatrix.needsUpdate = true;
    if (this.discs.instanceColor) this.discs.instanceColor.needsUpdate = true;
  }
}

function discs(shape: BufferGeometry, count: number, order: number):
  InstancedMesh<BufferGeometry, MeshBasicMaterial> {
  const mesh = new InstancedMesh(shape.rotateX(-Math.PI / 2),
    new MeshBasicMaterial({depthWrite: false}), count);
  mesh.count = 0;
  mesh.instanceMatrix.setUsage(DynamicDrawUsage);
  mesh.frustumCulled = false;
  mesh.renderOrder = order;
  return mesh;
}
