// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The shown instant, in frames and fractions. Has no clock: advance() gets the elapsed
// time.

export class Playback {
  /** First and last available frame, both included. */
  first = 0;
  last = 0;
  /** The shown instant [frames]. */
  time = 0;
  rate_hz = 30;
  speed = 1;
  loop = false;
  playing = false;
  /** Live: always shows the newest frame. */
  following = false;
  /** Frames that are played again and again, both included; null: all. Ends with a jump. */
  cycle: readonly [number, number] | null = null;
  /** Number of jumps by the user. */
  seeks = 0;

  get frame(): number {
    return Math.min(Math.max(Math.round(this.time), this.first), this.last);
  }

  /** Moves the instant forward if the ring drops its frame. */
  setRange(first: number, last: number): void {
    this.first = first;
    this.last = Math.max(last, first);
    this.time = this.following ? this.last : this.clamped(this.time);
  }

  seek(time: number): void {
    this.following = false;
    this.cycle = null;
    ++this.seeks;
    this.time = this.clamped(time);
  }

  /** Goes to the whole frame at distance `count` and stops playing. */
  step(count: number): void {
    this.playing = false;
    this.seek(this.frame + count);
  }

  /** Plays the frames `first` to `last` again and again. */
  playCycle(first: number, last: number): void {
    this.seek(first);
    this.cycle = [this.clamped(first), this.clamped(last)];
    this.playing = true;
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

  /** Advances by `seconds` of real time. At the end it restarts (loop), follows the newest
   *  frame (`live`) or stops. */
  advance(seconds: number, live: boolean): void {
    if (!this.playing || this.following) return;
    const [first, last] = this.cycle ?? [this.first, this.last];
    const length = last - first;
    this.time += seconds * this.rate_hz * this.speed;
    if (this.time <= last) return;
    if (live) {
      this.follow();
    } else if ((this.loop || this.cycle) && length > 0) {
      this.time = first + (this.time - first) % length;
    } else {
      this.time = last;
      this.playing = false;
    }
  }

  private clamped(time: number): number {
    return Math.min(Math.max(time, this.first), this.last);
  }
}
