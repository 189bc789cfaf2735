// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Timeline rows of segments: frames measured, repaired, inferred or absent. A file lists its
// gaps; a live session stores a source per frame.

import {ABSENT} from './frame_ring';
import type {FrameRing} from './frame_ring';
import type {ContactWords, FileWords, GraphWords} from './protocol';
import {SOURCES} from './protocol';

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

export class FileRows implements Rows {
  readonly names: readonly string[];
  private readonly tracks: FileWords['tracks'];

  constructor(file: FileWords) {
    // Counted from 0, as in the playback.
    this.tracks = file.tracks.map(({name, gaps}) => ({name, gaps: gaps.map(
      ([first, last, source]) => [first - file.first_frame, last - file.first_frame, source])}));
    this.names = file.tracks.map((track) => track.name);
  }

  spans(row: number, from: number, to: number, _stride: number, visit: Visit): void {
    for (const [first, last, source] of this.tracks[row].gaps) {
      if (last >= from && first <= to) visit(first, last, SOURCES.indexOf(source));
    }
  }

  source(row: number, frame: number): number {
    const gap = this.tracks[row].gaps.find(([first, last]) => frame >= first && frame <= last);
    return gap ? SOURCES.indexOf(gap[2]) : 0;
  }
}

export class RingRows implements Rows {
  constructor(readonly names: readonly string[], private readonly ring: FrameRing) {}

  spans(row: number, from: number, to: number, stride: number, visit: Visit): void {
    ringRuns(this.ring, from, to, stride, (frame) => this.ring.source(frame, row), visit);
  }

  source(row: number, frame: number): number {
    return isHere(this.ring, frame) ? this.ring.source(frame, row) : ABSENT;
  }
}

/** Contacts over time, as runs of BEARS. */
export const BEARS = 1;

export class FileContacts implements Rows {
  readonly names: readonly string[];
  private readonly all: ContactWords['spans'][];

  constructor(file: FileWords) {
    this.names = file.contacts.map(({name}) => name);
    this.all = file.contacts.map(({spans}) => spans.map(
      ([first, last]) => [first - file.first_frame, last - file.first_frame]));
  }

  spans(row: number, from: number, to: number, _stride: number, visit: Visit): void {
    for (const [first, last] of this.all[row]) {
      if (last >= from && first <= to) visit(first, last, BEARS);
    }
  }

  source(row: number, frame: number): number {
    return this.all[row].some(([first, last]) => frame >= first && frame <= last) ? BEARS : 0;
  }
}

/** Rows are the bits of a frame's `bears`. */
export class RingContacts implements Rows {
  readonly names = ['left heel', 'left ball', 'right heel', 'right ball'];
  constructor(private readonly ring: FrameRing) {}

  spans(row: number, from: number, to: number, stride: number, visit: Visit): void {
    ringRuns(this.ring, from, to, stride, (frame) => this.ring.bears(frame) >> row & 1, visit);
  }

  source(row: number, frame: number): number {
    return isHere(this.ring, frame) ? this.ring.bears(frame) >> row & 1 : 0;
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
  readonly name: string;
  readonly unit: string;
  /** Frames from `first` to `end - 1`. */
  readonly first: number;
  readonly end: number;
  /** null: unknown or absent. */
  at(frame: number): number | null;
}

export class FileCurve implements Curve {
  readonly name: string;
  readonly unit: string;
  readonly first = 0;
  readonly end: number;
  private readonly values: GraphWords['values'];

  constructor({name, unit, values}: GraphWords) {
    this.name = name;
    this.unit = unit;
    this.values = values;
    this.end = values.length;
  }

  at(frame: number): number | null {
    return this.values[frame] ?? null;
  }
}

export class RingResidual implements Curve {
  readonly name = 'reprojection';
  readonly unit = 'px';
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
