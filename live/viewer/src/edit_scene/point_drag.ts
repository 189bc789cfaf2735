// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Dragging of points on the floor with mouse and touch. Other gestures go on to the handles
// and to the orbit.

import type {Place} from './path_changes';
import {curveThrough, nearestOnPath} from '../scene/floor_path';
import {dragInPlane} from '../scene/drag_plane';
import type {PathView} from '../scene/path_view';
import type {Stage} from '../scene/stage';
import type {Vector} from '../protocol/protocol';

const MOUSE_REACH_PX = 14;
const TOUCH_REACH_PX = 28;
const MIN_DRAG_PX = 2;
/** Farther away, a pixel is too far on the floor. */
const MAX_AWAY_M = 60;
/** Places on the curve between two points. */
export const CURVE_STEPS = 16;

export interface PointListener {
  /** `points` with the dragged one in its new place. `ended`: the drag is over. */
  moved(points: Place[], ended: boolean): void;
  /** The drag was given up. */
  cancelled(): void;
  /** A point was added or removed. */
  changed(points: Place[]): void;
  selected(): void;
}

interface Grip {index: number; pointer: number; off: [number, number]; at: [number, number];
  moved: boolean; before: Place[]}

export class PointDrag {
  /** Gestures are only watched while it is on. */
  on = false;
  private grip: Grip | null = null;

  /** Precondition: the stage exists, so that its handles are taken first. */
  constructor(private readonly stage: Stage, private readonly view: PathView,
    private readonly listener: PointListener) {
    const {canvas} = stage.renderer;
    canvas.addEventListener('pointerdown', (event) => this.down(event), true);
    canvas.addEventListener('pointermove', (event) => this.move(event), true);
    canvas.addEventListener('dblclick', (event) => this.add(event), true);
    canvas.addEventListener('keydown', (event) => this.key(event));
    for (const kind of ['pointerup', 'pointercancel', 'lostpointercapture'] as const) {
      canvas.addEventListener(kind, ({pointerId}) => {
        if (pointerId === this.grip?.pointer) this.letGo();
      });
    }
  }

  get isDragging(): boolean {
    return this.grip !== null;
  }

  private copy(): Place[] {
    return this.view.points.map(([x, z]): Place => [x, z]);
  }

  private onFloor(x_px: number, y_px: number): Place | null {
    const {renderer, floor_m} = this.stage;
    const met = dragInPlane(renderer.eye, renderer.rayThrough(x_px, y_px), [0, floor_m, 0],
      [0, 1, 0]);
    const {x, z} = renderer.orbit.target;
    return met && Math.hypot(met[0] - x, met[2] - z) < MAX_AWAY_M ? [met[0], met[2]] : null;
  }

  private nearest(event: MouseEvent): number {
    const {offsetX, offsetY} = event;
    const isTouch = event instanceof PointerEvent && event.pointerType !== 'mouse';
    let best = -1;
    let least = isTouch ? TOUCH_REACH_PX : MOUSE_REACH_PX;
    this.view.points.forEach((_, i) => {
      const at = this.stage.renderer.pixelOf(this.view.pointInWorld(i));
      const away = at ? Math.hypot(at[0] - offsetX, at[1] - offsetY) : Infinity;
      if (away <= least) [best, least] = [i, away];
    });
    return best;
  }

  private down(event: PointerEvent): void {
    if (this.grip) {
      // A second finger turns a drag into a change of the view.
      this.letGo();
      return;
    }
    const index = this.on && event.button === 0 ? this.nearest(event) : -1;
    if (index < 0) return;
    event.stopImmediatePropagation();
    const {renderer} = this.stage;
    renderer.canvas.setPointerCapture(event.pointerId);
    const at = renderer.pixelOf(this.view.pointInWorld(index))!;
    this.grip = {index, pointer: event.pointerId, moved: false, before: this.copy(),
      off: [at[0] - event.offsetX, at[1] - event.offsetY], at: [event.offsetX, event.offsetY]};
    this.view.held = index;
    this.select(index);
  }

  private move(event: PointerEvent): void {
    const {grip, stage: {renderer}} = this;
    if (!grip) {
      if (event.pointerType === 'mouse' && event.buttons === 0) this.hover(event);
      return;
    }
    if (event.pointerId !== grip.pointer) return;
    const {offsetX: x, offsetY: y} = event;
    if (!grip.moved && Math.hypot(x - grip.at[0], y - grip.at[1]) < MIN_DRAG_PX) return;
    const place = this.onFloor(x + grip.off[0], y + grip.off[1]);
    if (!place) return;
    grip.moved = true;
    const points = this.copy();
    points[grip.index] = place;
    this.listener.moved(points, false);
    renderer.invalidate();
  }

  private hover(event: PointerEvent): void {
    const held = this.on ? this.nearest(event) : -1;
    if (held === this.view.held) return;
    this.view.held = held;
    this.stage.renderer.canvas.classList.toggle('over-point', held >= 0);
    this.stage.refresh();
  }

  private letGo(): void {
    const moved = this.grip?.moved ?? false;
    this.grip = null;
    this.view.held = -1;
    if (moved) this.listener.moved(this.copy(), true);
    this.stage.refresh();
  }

  private giveUp(): void {
    const {before} = this.grip!;
    this.grip = null;
    this.view.held = -1;
    this.view.setPoints(before, curveThrough(before, CURVE_STEPS));
    this.listener.cancelled();
    this.stage.refresh();
  }

  private select(index: number): void {
    this.view.selected = index;
    this.listener.selected();
    this.stage.refresh();
  }

  /** Adds a point where the curve was double-clicked. */
  private add(event: MouseEvent): void {
    if (!this.on) return;
    if (this.nearest(event) >= 0) {
      event.stopImmediatePropagation();
      return;
    }
    const place = this.onFloor(event.offsetX, event.offsetY);
    const near = place && nearestOnPath(curveThrough(this.view.points, CURVE_STEPS), ...place);
    if (!near) return;
    const on: Vector = [near.x, this.stage.floor_m, near.z];
    const at = this.stage.renderer.pixelOf(on);
    if (!at || Math.hypot(at[0] - event.offsetX, at[1] - event.offsetY) > MOUSE_REACH_PX) return;
    event.stopImmediatePropagation();
    const points = this.copy();
    const index = Math.floor(near.segment / CURVE_STEPS) + 1;
    points.splice(index, 0, [near.x, near.z]);
    this.view.selected = index;
    this.listener.changed(points);
  }

  /** Removes point i. A path keeps two. */
  remove(i: number): void {
    if (i < 0 || i >= this.view.points.length || this.view.points.length <= 2) return;
    const points = this.copy();
    points.splice(i, 1);
    this.view.selected = Math.min(this.view.selected, points.length - 1);
    this.listener.changed(points);
  }

  private key(event: KeyboardEvent): void {
    if (!this.on) return;
    const removes = (event.key === 'Delete' || event.key === 'Backspace') &&
      this.view.selected >= 0 && !this.grip;
    const cancels = event.key === 'Escape' && this.grip !== null;
    if (!removes && !cancels) return;
    event.preventDefault();
    event.stopPropagation();
    if (removes) this.remove(this.view.selected);
    else this.giveUp();
  }
}
