// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The current time, shared by the viewer and every graph of a trial.

class Player {
  constructor() {
    this.time = 0; // In frames from the first.
    this.frames = 1;
    this.rate = 30;
    this.speed = 1;
    this.playing = false;
    this.listeners = new Set();
  }

  /** `then` is called whenever the time or the playing state changes. */
  listen(then) {
    this.listeners.add(then);
  }

  /** Sets another trial and removes all listeners of the last one. */
  load(frames, rate) {
    this.listeners.clear();
    this.frames = Math.max(frames, 1);
    this.rate = rate;
    this.time = 0;
  }

  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.frames - 1);
    this.#tell();
  }

  step(frames) {
    this.play(false);
    this.seek(Math.round(this.time) + frames);
  }

  play(on) {
    if (this.playing === on) return;
    this.playing = on;
    this.before = null;
    this.#tell();
    if (on) requestAnimationFrame((now) => this.#advance(now));
  }

  #advance(now) {
    if (!this.playing) return;
    // The step is limited, so that a page that was suspended does not jump.
    const elapsed = this.before === null ? 0 : Math.min((now - this.before) / 1000, 0.1);
    this.before = now;
    let time = this.time + elapsed * this.rate * this.speed;
    if (time > this.frames - 1) time = 0;
    this.seek(time);
    requestAnimationFrame((next) => this.#advance(next));
  }

  #tell() {
    for (const then of this.listeners) then();
  }
}
