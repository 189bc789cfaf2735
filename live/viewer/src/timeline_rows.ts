// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// What the timeline shows of each segment: where it was measured, repaired, inferred or
// absent. A file tells its gaps; a live session remembers a source per frame.

import {ABSENT} from './frame_ring';
import type {FrameRing} from './frame_ring';
import type {FileWords} from './protocol';
import {SOURCES} from './protocol';

/** Visited from left to right; both ends included; `source` into SOURCES, or ABSENT. */
export type Visit = (first: number, last: number, source: number) => void;

export interface Rows {
  readonly names: readonly string[];
  /** What is not plainly measured in row `row`, from frame `from` to `to`. Looks at every
   *  `stride`-th frame at least. */
  spans(row: number, from: number, to: number, stride: number, visit: Visit): void;
  /** Of one frame. */
  source(row: number, frame: number): number;
}

export class FileRows implements Rows {
  readonly names: readonly string[];
  private readonly tracks: FileWords['tracks'];

  constructor(file: FileWords) {
    // Counted from 0, as the playback does.
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
    const {ring} = this;
    const last = Math.min(Math.floor(to), ring.next - 1);
    const step = Math.max(1, Math.floor(stride));
    // Whole strides since the beginning: what is skipped stays the same as time goes on.
    let frame = Math.ceil(Math.max(from, ring.first) / step) * step;
    let start = frame;
    let run = 0;
    for (; frame <= last; frame += step) {
      const source = ring.source(frame, row);
      if (source === run) continue;
      if (run !== 0) visit(start, frame - 1, run);
      run = source;
      start = frame;
    }
    if (run !== 0 && start <= last) visit(start, last, run);
  }

  source(row: number, frame: number): number {
    const {ring} = this;
    return frame >= ring.first && frame < ring.next ? ring.source(frame, row) : ABSENT;
  }
}

export function sourceWords(source: number): string {
  return source === ABSENT ? 'not there' : SOURCES[source];
}
