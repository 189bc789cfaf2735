// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Dragging of handles with mouse and touch. Other gestures go on to the orbit.

import type {DragPhase, Vector} from '../protocol/protocol';
import type {ConstraintView, Handle} from './constraint_view';
import {dragInPlane, dragVertically} from './drag_plane';
import type {Renderer} from './renderer';

const MOUSE_REACH_PX = 14;
const TOUCH_REACH_PX = 28;

/** Longest time between the two presses of a double click or double tap. */
const DOUBLE_MS = 400;
/** Movement up to which a press is a click and no drag. */
const STILL_PX = 5;

export interface HandleActions {
  /** Escape ends a drag with it, instead of with the phase `end`. */
  giveUp?: (id: string) => void;
  /** A handle was clicked or tapped twice. */
  release?: (id: string) => void;
}

/** The last click on a handle. */
interface Click {id: string; at: [number, number]; time_ms: number}

/** A drag: where it began, its plane, and how far off the handle's centre the pointer is. */
interface Grip {id: string; pointer: number; start: Vector; normal: Vector; off: [number, number]}

export class HandleDrag {
  private grip: Grip | null = null;
  private click: Click | null = null;
  /** The last press released a handle. */
  hasReleased = false;

  constructor(private readonly renderer: Renderer, private readonly view: ConstraintView,
    private readonly drag: (id: string, p_in_world: Vector, phase: DragPhase) => void,
    private readonly actions: HandleActions = {}) {
    const {canvas} = renderer;
    const {giveUp} = actions;
    // Before the orbit's own listeners.
    canvas.addEventListener('pointerdown', (event) => this.down(event), true);
    canvas.addEventListener('pointermove', (event) => this.move(event), true);
    for (const kind of ['pointerup', 'pointercancel', 'lostpointercapture'] as const) {
      canvas.addEventListener(kind, ({pointerId}) => {
        if (pointerId === this.grip?.pointer) this.letGo();
      });
    }
    if (giveUp) {
      // Whichever element has the focus.
      window.addEventListener('keydown', (event) => {
        if (event.key === 'Escape' && this.grip) this.drop(event, giveUp);
      }, true);
    }
  }

  /** Id of the dragged handle. */
  get inHand(): string | null {
    return this.grip?.id ?? null;
  }

  private nearest({offsetX, offsetY, pointerType}: PointerEvent): Handle | null {
    if (!this.view.object.visible) return null;
    let best: Handle | null = null;
    let least = pointerType === 'mouse' ? MOUSE_REACH_PX : TOUCH_REACH_PX;
    for (const handle of this.view.handles) {
      if (!handle.words.draggable || !handle.object.visible) continue;
      const at = this.renderer.pixelOf(handle.shown_in_world);
      if (!at) continue;
      const away = Math.hypot(at[0] - offsetX, at[1] - offsetY);
      if (away <= least) [best, least] = [handle, away];
    }
    return best;
  }

  private down(event: PointerEvent): void {
    if (this.grip) {
      // A second finger turns a drag into a change of the view.
      this.letGo();
      return;
    }
    this.hasReleased = false;
    const taken = event.button === 0 ? this.nearest(event) : null;
    if (!taken) {
      this.click = null;
      return;
    }
    event.stopImmediatePropagation();
    if (this.isSecondClick(taken.words.id, event)) {
      this.click = null;
      this.hasReleased = true;
      this.actions.release!(taken.words.id);
      return;
    }
    this.click = {id: taken.words.id, at: [event.offsetX, event.offsetY], time_ms: event.timeStamp};
    this.renderer.canvas.setPointerCapture(event.pointerId);
    const start: Vector = [...taken.shown_in_world];
    const at = this.renderer.pixelOf(start)!;
    const {id} = taken.words;
    this.grip = {id, pointer: event.pointerId, start, normal: this.renderer.facing(),
      off: [at[0] - event.offsetX, at[1] - event.offsetY]};
    this.view.held = id;
    this.drag(id, taken.words.p_in_world, 'begin');
  }

  private isSecondClick(id: string, event: PointerEvent): boolean {
    return this.actions.release !== undefined && this.click?.id === id &&
      event.timeStamp - this.click.time_ms <= DOUBLE_MS && this.isStill(event);
  }

  /** A moving target takes its handle along: the pointer's own place counts. */
  private isStill({offsetX, offsetY}: PointerEvent): boolean {
    if (!this.click) return false;
    const [x, y] = this.click.at;
    return Math.hypot(offsetX - x, offsetY - y) <= STILL_PX;
  }

  private move(event: PointerEvent): void {
    const {grip, renderer, view} = this;
    if (!grip) {
      if (event.pointerType === 'mouse' && event.buttons === 0) this.hover(event);
      return;
    }
    // The server may have sent the handles again meanwhile.
    const moved = view.handles.find(({words}) => words.id === grip.id);
    if (!moved || event.pointerId !== grip.pointer) return;
    if (!this.isStill(event)) this.click = null;
    const ray = renderer.rayThrough(event.offsetX + grip.off[0], event.offsetY + grip.off[1]);
    const to = event.shiftKey ? dragVertically(renderer.eye, ray, grip.start)
      : dragInPlane(renderer.eye, ray, grip.start, grip.normal);
    if (!to) return;
    view.move(moved, to);
    this.drag(grip.id, moved.words.p_in_world, 'move');
    renderer.invalidate();
  }

  private hover(event: PointerEvent): void {
    const held = this.nearest(event)?.words.id ?? null;
    if (held === this.view.held) return;
    this.view.held = held;
    this.renderer.canvas.classList.toggle('over-handle', held !== null);
    this.renderer.invalidate();
  }

  private drop(event: Event, giveUp: (id: string) => void): void {
    event.stopImmediatePropagation();
    const {id} = this.grip!;
    this.grip = null;
    this.view.held = null;
    giveUp(id);
    this.renderer.invalidate();
  }

  private letGo(): void {
    const moved = this.view.handles.find(({words}) => words.id === this.grip?.id);
    this.grip = null;
    this.view.held = null;
    if (moved) this.drag(moved.words.id, moved.words.p_in_world, 'end');
    this.renderer.invalidate();
  }
}
