// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Which instant is shown, counted in frames and between them. Knows no clock: advance() is
// told how long it was.

export class Playback {
  /** First and last frame there is, both included. */
  first = 0;
  last = 0;
  /** The instant shown. */
  time = 0;
  rate_hz = 30;
  speed = 1;
  loop = false;
  playing = false;
  /** Live: shows the newest, whatever comes. */
  following = false;
  /** How often somebody went somewhere. */
  seeks = 0;

  get frame(): number {
    return Math.min(Math.max(Math.round(this.time), this.first), this.last);
  }

  /** A ring that forgets its oldest frames takes the instant along. */
  setRange(first: number, last: number): void {
    this.first = first;
    this.last = Math.max(last, first);
    this.time = this.following ? this.last : this.clamped(this.time);
  }

  seek(time: number): void {
    this.following = false;
    ++this.seeks;
    this.time = this.clamped(time);
  }

  /** To a whole frame, `count` away; playing ends. */
  step(count: number): void {
    this.playing = false;
    this.seek(this.frame + count);
  }

  play(): void {
    if (!this.loop && !this.following && this.time >= this.last) this.time = this.first;
    this.playing = true;
  }

  pause(): void {
    this.playing = false;
    this.following = false;
  }

  follow(): void {
    this.following = true;
    this.playing = true;
    this.time = this.last;
  }

  /** Goes on by so many seconds of the viewer's time. At the end it starts anew (loop),
   *  follows (`live`: what comes next has just arrived) or stops. */
  advance(seconds: number, live: boolean): void {
    if (!this.playing || this.following) return;
    const length = this.last - this.first;
    this.time += seconds * this.rate_hz * this.speed;
    if (this.time <= this.last) return;
    if (live) {
      this.follow();
    } else if (this.loop && length > 0) {
      this.time = this.first + (this.time - this.first) % length;
    } else {
      this.time = this.last;
      this.playing = false;
    }
  }

  private clamped(time: number): number {
    return Math.min(Math.max(time, this.first), this.last);
  }
}
