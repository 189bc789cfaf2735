// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Mouse, touch and wheel on the canvas: orbit the view and drag handles.

import type {Orbit} from './orbit';

export interface Grip {
  /** Pointer position in pixels of the canvas, with or without shift. */
  move(x_px: number, y_px: number, vertical: boolean): void;
  /** The pointer is released, or the gesture was cancelled. */
  end(): void;
}

export interface GestureListener {
  /** Returns the handle at this place, if any, within `reach_px`. */
  grip(x_px: number, y_px: number, reach_px: number): Grip | null;
  /** The pointer is over this place and not pressed. */
  hover(x_px: number, y_px: number): void;
  changed(): void;
  reset(): void;
}

const MOUSE_REACH_PX = 14;
const TOUCH_REACH_PX = 28;

export class Gestures {
  private readonly pointers = new Map<number, [number, number]>();
  private grip: Grip | null = null;
  private gripId = -1;

  constructor(private readonly canvas: HTMLCanvasElement, private readonly orbit: Orbit,
    private readonly listener: GestureListener) {
    canvas.addEventListener('pointerdown', (event) => this.down(event));
    canvas.addEventListener('pointermove', (event) => this.move(event));
    for (const kind of ['pointerup', 'pointercancel', 'lostpointercapture'] as const) {
      canvas.addEventListener(kind, (event) => this.up(event));
    }
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.orbit.zoom(Math.exp(0.0012 * event.deltaY));
      listener.changed();
    }, {passive: false});
    canvas.addEventListener('dblclick', () => listener.reset());
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  private down(event: PointerEvent): void {
    const {offsetX: x, offsetY: y} = event;
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [x, y]);
    if (this.pointers.size > 1) {
      // A second finger turns a drag into a change of the view.
      this.letGo();
      return;
    }
    if (event.button !== 0) return;
    const reach = event.pointerType === 'mouse' ? MOUSE_REACH_PX : TOUCH_REACH_PX;
    this.grip = this.listener.grip(x, y, reach);
    this.gripId = event.pointerId;
  }

  private move(event: PointerEvent): void {
    const {offsetX: x, offsetY: y} = event;
    const before = this.pointers.get(event.pointerId);
    if (!before) {
      if (event.pointerType === 'mouse') this.listener.hover(x, y);
      return;
    }
    this.pointers.set(event.pointerId, [x, y]);
    if (this.grip) {
      if (event.pointerId === this.gripId) this.grip.move(x, y, event.shiftKey);
      return;
    }
    const [dx, dy] = [x - before[0], y - before[1]];
    if (this.pointers.size === 2) this.pinch(event.pointerId, before, [x, y]);
    else if (event.shiftKey || (event.buttons & 6) !== 0) {
      this.orbit.pan(dx, dy, this.canvas.clientHeight);
    } else this.orbit.turn(dx, dy);
    this.listener.changed();
  }

  private pinch(id: number, before: [number, number], now: [number, number]): void {
    for (const [other, at] of this.pointers) {
      if (other === id) continue;
      const gap = (p: [number, number]): number => Math.hypot(p[0] - at[0], p[1] - at[1]) || 1;
      this.orbit.zoom(gap(before) / gap(now));
      this.orbit.pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2,
        this.canvas.clientHeight);
    }
  }

  private up(event: PointerEvent): void {
    this.pointers.delete(event.pointerId);
    if (event.pointerId === this.gripId) this.letGo();
  }

  private letGo(): void {
    this.grip?.end();
    this.grip = null;
    this.gripId = -1;
  }
}
