// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The part of a recording that the timeline shows; converts frames to pixels and back.

const MIN_FRAMES = 8;

export class TimeWindow {
  /** Frames at the left and the right edge; fractions are allowed. */
  from = 0;
  to = 1;
  private first = 0;
  private last = 1;
  private readonly watchers: (() => void)[] = [];

  /** `then` is called when the window shows other frames. */
  watch(then: () => void): void {
    this.watchers.push(then);
  }

  /** Sets the available frames. A window that showed all of them still does; a zoomed window
   *  stays, or moves if its frames are gone. */
  setRange(first: number, last: number): void {
    const whole = this.whole;
    this.first = first;
    this.last = Math.max(last, first + 1);
    if (whole) {
      this.showAll();
    } else {
      this.place(this.from, this.to - this.from);
    }
  }

  get whole(): boolean {
    return this.from <= this.first && this.to >= this.last;
  }

  showAll(): void {
    this.show(this.first, this.last);
  }

  /** Zooms by `factor` (below 1: nearer) with the frame at `centre` fixed. */
  zoom(factor: number, centre: number): void {
    const all = this.last - this.first;
    const length = Math.min(Math.max((this.to - this.from) * factor,
      Math.min(MIN_FRAMES, all)), all);
    const share = (centre - this.from) / (this.to - this.from);
    this.place(centre - share * length, length);
  }

  pan(frames: number): void {
    this.place(this.from + frames, this.to - this.from);
  }

  /** Moves as little as needed to make this frame visible. */
  reveal(frame: number): void {
    if (frame < this.from) this.pan(frame - this.from);
    else if (frame > this.to) this.pan(frame - this.to);
  }

  x(frame: number, width: number): number {
    return (frame - this.from) / (this.to - this.from) * width;
  }

  frame(x: number, width: number): number {
    return this.from + x / Math.max(width, 1) * (this.to - this.from);
  }

  private place(from: number, length: number): void {
    const all = Math.min(length, this.last - this.first);
    const start = Math.min(Math.max(from, this.first), this.last - all);
    this.show(start, start + all);
  }

  private show(from: number, to: number): void {
    if (from === this.from && to === this.to) return;
    this.from = from;
    this.to = to;
    for (const then of this.watchers) then();
  }
}

/** Returns the step of a time axis: the first of at least `least_s` among 1, 2 and 5 times
 *  powers of ten and the usual multiples of minutes. [s] */
export function tickStep_s(least_s: number): number {
  for (const minutes of [60, 120, 300, 600, 1800, 3600]) {
    if (least_s > 30 && least_s <= minutes) return minutes;
  }
  if (least_s > 10 && least_s <= 30) return 30;
  const power = 10 ** Math.floor(Math.log10(Math.max(least_s, 1e-4)));
  for (const of of [1, 2, 5]) {
    if (of * power >= least_s * (1 - 1e-9)) return of * power;
  }
  return 10 * power;
}

/** 0:07.25, 1:02.00, 1:00:00 */
export function clockWords(time_s: number, decimals = 2): string {
  const sign = time_s < 0 ? '−' : '';
  const scale = 10 ** decimals;
  // Rounded first: 59.999 s is a minute, not 0:60.00.
  const whole = Math.round(Math.abs(time_s) * scale);
  const seconds = whole / scale;
  const minutes = Math.floor(seconds / 60);
  const hours = Math.floor(minutes / 60);
  const rest = (seconds - 60 * minutes).toFixed(decimals)
    .padStart(decimals > 0 ? 3 + decimals : 2, '0');
  return hours > 0 ? `${sign}${hours}:${String(minutes % 60).padStart(2, '0')}:${rest}`
    : `${sign}${minutes}:${rest}`;
}
