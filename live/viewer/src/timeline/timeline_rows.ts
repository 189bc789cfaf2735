// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Timeline rows of segments: frames measured, repaired, inferred or absent. A file lists its
// gaps; a live session stores a source per frame.

import {ABSENT} from './frame_ring';
import type {FrameRing} from './frame_ring';
import type {FileWords} from '../protocol/protocol';
import {SOURCES} from '../protocol/protocol';

/** Visited from left to right; both ends included; `source` is an index into SOURCES or
 *  ABSENT. */
export type Visit = (first: number, last: number, source: number) => void;

export interface Rows {
  readonly names: readonly string[];
  /** Visits the runs of row `row` that are not measured, from frame `from` to `to`. Checks at
   *  least every `stride`-th frame. */
  spans(row: number, from: number, to: number, stride: number, visit: Visit): void;
  /** Returns the source of one frame. */
  source(row: number, frame: number): number;
}

/** A run of frames, both ends included, and its source. */
export type Run = readonly [number, number, number];

/** Rows of listed runs; what is in none has the source 0. */
export class RunRows implements Rows {
  constructor(readonly names: readonly string[], private readonly runs: readonly Run[][]) {}

  spans(row: number, from: number, to: number, _stride: number, visit: Visit): void {
    for (const [first, last, source] of this.runs[row]) {
      if (last >= from && first <= to) visit(first, last, source);
    }
  }

  source(row: number, frame: number): number {
    return this.runs[row].find(([first, last]) => frame >= first && frame <= last)?.[2] ?? 0;
  }
}

/** Gaps of a file, counted from 0, as in the playback. */
export class FileRows extends RunRows {
  constructor({tracks, first_frame}: Partial<FileWords> &
    Pick<FileWords, 'tracks' | 'first_frame'>) {
    super(tracks.map(({name}) => name), tracks.map(({gaps}) => gaps.map(([first, last, source]) =>
      [first - first_frame, last - first_frame, SOURCES.indexOf(source)])));
  }
}

/** Contacts over time, as runs of BEARS. */
export const BEARS = 1;

export class FileContacts extends RunRows {
  constructor({contacts, first_frame}: FileWords) {
    super(contacts.map(({name}) => name), contacts.map(({spans}) => spans.map(([first, last]) =>
      [first - first_frame, last - first_frame, BEARS])));
  }
}

/** Rows with a stored value per frame. */
abstract class ValueRows implements Rows {
  constructor(readonly names: readonly string[], protected readonly ring: FrameRing,
    private readonly missing: number) {}

  protected abstract value(row: number, frame: number): number;

  spans(row: number, from: number, to: number, stride: number, visit: Visit): void {
    ringRuns(this.ring, from, to, stride, (frame) => this.value(row, frame), visit);
  }

  source(row: number, frame: number): number {
    return isHere(this.ring, frame) ? this.value(row, frame) : this.missing;
  }
}

export class RingRows extends ValueRows {
  constructor(names: readonly string[], ring: FrameRing) {
    super(names, ring, ABSENT);
  }

  protected override value(row: number, frame: number): number {
    return this.ring.source(frame, row);
  }
}

/** Rows are the bits of a frame's `bears`. */
export class RingContacts extends ValueRows {
  constructor(ring: FrameRing) {
    super(['left heel', 'left ball', 'right heel', 'right ball'], ring, 0);
  }

  protected override value(row: number, frame: number): number {
    return this.ring.bears(frame) >> row & 1;
  }
}

function isHere(ring: FrameRing, frame: number): boolean {
  return frame >= ring.first && frame < ring.next;
}

/** Visits runs of frames with the same value other than 0. */
function ringRuns(ring: FrameRing, from: number, to: number, stride: number,
  value: (frame: number) => number, visit: Visit): void {
  const last = Math.min(Math.floor(to), ring.next - 1);
  const step = Math.max(1, Math.floor(stride));
  // Strides are counted from the beginning, so that the skipped frames stay the same.
  let frame = Math.ceil(Math.max(from, ring.first) / step) * step;
  let start = frame;
  let run = 0;
  for (; frame <= last; frame += step) {
    const now = value(frame);
    if (now === run) continue;
    if (run !== 0) visit(start, frame - 1, run);
    run = now;
    start = frame;
  }
  if (run !== 0 && start <= last) visit(start, last, run);
}

/** A value over time, from a file or from the stored part of a live session. */
export interface Curve {
  /** Frames from `first` to `end - 1`. */
  readonly first: number;
  readonly end: number;
  /** Name of a colour; the accent without one. */
  readonly colour?: string;
  readonly dash?: number[];
  readonly width?: number;
  /** null: unknown or absent. */
  at(frame: number): number | null;
}

export function listedCurve(values: readonly (number | null)[],
  look: Pick<Curve, 'colour' | 'dash' | 'width'> = {}): Curve {
  return {first: 0, end: values.length, at: (frame) => values[frame] ?? null, ...look};
}

export class RingResidual implements Curve {
  constructor(private readonly ring: FrameRing) {}

  get first(): number {
    return this.ring.first;
  }

  get end(): number {
    return this.ring.next;
  }

  at(frame: number): number | null {
    if (!isHere(this.ring, frame)) return null;
    const value = this.ring.residual_px(frame);
    return Number.isNaN(value) ? null : value;
  }
}

export function sourceWords(source: number): string {
  return source === ABSENT ? 'not there' : SOURCES[source];
}
