// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The eye that orbits the motion; controlled by mouse, touch and keys.

const VIEW_ANGLE = 0.62; // [rad], vertical

class Orbit {
  /** `changed` is called when the user moves the eye. */
  constructor(canvas, changed) {
    this.canvas = canvas;
    this.changed = changed;
    this.home = {target: [0, 0.9, 0], distance: 4, azimuth: 0.6, height: 0.22};
    this.pointers = new Map();
    this.reset();
    this.#listen();
  }

  reset() {
    Object.assign(this, structuredClone(this.home));
    this.touched = false;
    this.changed();
  }

  /** Sets a view: target, distance, azimuth, height; reset() returns to it. */
  frame(view) {
    this.home = view;
    this.reset();
  }

  eye() {
    const flat = this.distance * Math.cos(this.height);
    return add(this.target, [flat * Math.sin(this.azimuth),
      this.distance * Math.sin(this.height), flat * Math.cos(this.azimuth)]);
  }

  turn(dx, dy) {
    this.azimuth -= 0.008 * dx;
    this.height = Math.min(Math.max(this.height + 0.006 * dy, 0.02), 1.5);
    this.#moved();
  }

  zoom(factor) {
    this.distance = Math.min(Math.max(this.distance * factor, 0.6), 40);
    this.#moved();
  }

  pan(dx, dy) {
    const perPixel = 2 * this.distance * Math.tan(VIEW_ANGLE / 2) / this.canvas.clientHeight;
    const right = [Math.cos(this.azimuth), 0, -Math.sin(this.azimuth)];
    this.target = add(this.target, scaled(right, -dx * perPixel));
    this.target[1] = Math.max(0, this.target[1] + dy * perPixel);
    this.#moved();
  }

  #moved() {
    this.touched = true;
    this.changed();
  }

  #listen() {
    const {canvas} = this;
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    });
    for (const kind of ['pointerup', 'pointercancel', 'lostpointercapture']) {
      canvas.addEventListener(kind, (event) => this.pointers.delete(event.pointerId));
    }
    canvas.addEventListener('pointermove', (event) => this.#drag(event));
    canvas.addEventListener('wheel', (event) => {
      // The wheel zooms only after a click on the viewer, so that the page can scroll past it.
      if (document.activeElement !== canvas && !event.ctrlKey) return;
      event.preventDefault();
      this.zoom(Math.exp(0.0012 * event.deltaY));
    }, {passive: false});
    canvas.addEventListener('dblclick', () => this.reset());
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  #drag(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY];
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    if (this.pointers.size === 2) {
      const [other] = [...this.pointers].filter(([id]) => id !== event.pointerId);
      const gap = (p) => Math.hypot(p[0] - other[1][0], p[1] - other[1][1]) || 1;
      this.zoom(gap(before) / gap(now));
      this.pan(dx / 2, dy / 2);
    } else if (event.shiftKey || event.buttons === 2) {
      this.pan(dx, dy);
    } else {
      this.turn(dx, dy);
    }
    this.pointers.set(event.pointerId, now);
  }
}
