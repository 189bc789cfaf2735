// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The last minute of a live session, to look back at while it goes on.

/** Nobody was there: beyond the numbers of SOURCES. */
export const ABSENT = 3;

export class FrameRing {
  readonly capacity: number;
  readonly rows: number;
  /** Frames are counted from 0 for as long as the page is open; `first` to `next - 1` are
   *  still here. */
  next = 0;
  private readonly views: (DataView | null)[];
  private readonly sources: Uint8Array;
  private readonly bearing: Uint8Array;
  private readonly residuals_px: Float32Array;

  /** `rows`: joints whose source is kept for the timeline. */
  constructor(capacity: number, rows: number) {
    this.capacity = capacity;
    this.rows = rows;
    this.views = new Array<DataView | null>(capacity).fill(null);
    this.sources = new Uint8Array(capacity * rows);
    this.bearing = new Uint8Array(capacity);
    this.residuals_px = new Float32Array(capacity);
  }

  get first(): number {
    return Math.max(0, this.next - this.capacity);
  }

  get last(): number {
    return Math.max(0, this.next - 1);
  }

  /** Keeps a frame as it came (no copy). `source` of every row, null when nobody was
   *  there; `bears` and `residual_px` as a frame has them. */
  push(view: DataView, source: Uint8Array | null, bears = 0, residual_px = NaN): void {
    const slot = this.next % this.capacity;
    this.views[slot] = view;
    const at = slot * this.rows;
    for (let i = 0; i < this.rows; ++i) this.sources[at + i] = source ? source[i] : ABSENT;
    this.bearing[slot] = bears;
    this.residuals_px[slot] = residual_px;
    ++this.next;
  }

  /** null for a frame that is not here (any more). */
  at(frame: number): DataView | null {
    if (frame < this.first || frame >= this.next) return null;
    return this.views[frame % this.capacity];
  }

  /** Index into SOURCES, or ABSENT. Precondition: the frame is here. */
  source(frame: number, row: number): number {
    return this.sources[(frame % this.capacity) * this.rows + row];
  }

  /** What bore, in bits. Precondition: the frame is here. */
  bears(frame: number): number {
    return this.bearing[frame % this.capacity];
  }

  /** NaN: not known. Precondition: the frame is here. */
  residual_px(frame: number): number {
    return this.residuals_px[frame % this.capacity];
  }
}
