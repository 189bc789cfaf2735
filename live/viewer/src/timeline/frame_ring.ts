// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The last minute of a live session, for review while it continues.

/** The body was absent; a value outside SOURCES. */
export const ABSENT = 3;

export class FrameRing {
  readonly capacity: number;
  readonly rows: number;
  /** Frames are counted from 0 since the page was opened; `first` to `next - 1` are
   *  stored. */
  next = 0;
  private readonly views: (DataView | null)[];
  private readonly sources: Uint8Array;
  private readonly bearing: Uint8Array;
  private readonly residuals_px: Float32Array;

  /** `rows`: number of joints whose source is stored for the timeline. */
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

  /** Stores a received frame (no copy). `source` has one entry per row, null if the body was
   *  absent; `bears` and `residual_px` as a frame has them. */
  push(view: DataView, source: Uint8Array | null, bears = 0, residual_px = NaN): void {
    const slot = this.next % this.capacity;
    this.views[slot] = view;
    const at = slot * this.rows;
    for (let i = 0; i < this.rows; ++i) this.sources[at + i] = source ? source[i] : ABSENT;
    this.bearing[slot] = bears;
    this.residuals_px[slot] = residual_px;
    ++this.next;
  }

  /** Returns null for a frame that is not stored (any more). */
  at(frame: number): DataView | null {
    if (frame < this.first || frame >= this.next) return null;
    return this.views[frame % this.capacity];
  }

  /** Returns an index into SOURCES, or ABSENT. Precondition: the frame is stored. */
  source(frame: number, row: number): number {
    return this.sources[(frame % this.capacity) * this.rows + row];
  }

  /** Returns the contacts as bits. Precondition: the frame is stored. */
  bears(frame: number): number {
    return this.bearing[frame % this.capacity];
  }

  /** Returns the residual; NaN: unknown. Precondition: the frame is stored. */
  residual_px(frame: number): number {
    return this.residuals_px[frame % this.capacity];
  }
}
