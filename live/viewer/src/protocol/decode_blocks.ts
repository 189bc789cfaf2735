// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Blocks: a whole recording in one answer (docs/formats/page.md). They are read in
// place; only the offsets of frames are stored.

import {decodeFrame, SceneFrame} from './decode_frame';

const BLOCK_VERSION = 1;
const BLOCK_HEADER_BYTES = 16;
const POINT_BYTES = 16;

function readHeader(buffer: ArrayBuffer, magic: string): [number, number] {
  const view = new DataView(buffer);
  const word = buffer.byteLength >= BLOCK_HEADER_BYTES
    ? String.fromCharCode(...new Uint8Array(buffer, 0, 4)) : '';
  if (word !== magic) throw new Error(`the block does not begin with ${magic}`);
  const version = view.getUint32(4, true);
  if (version !== BLOCK_VERSION) throw new Error(`the block has the unknown version ${version}`);
  return [view.getUint32(8, true), view.getUint32(12, true)];
}

/** The frames of a recording. */
export class MotionBlock {
  readonly frames: number;
  private readonly view: DataView;
  private readonly starts: Float64Array;

  /** Throws an Error with the cause. `scratch` belongs to the block's scene; it holds the
   *  last frame afterwards. Linear in the block's size. */
  constructor(buffer: ArrayBuffer, scratch: SceneFrame) {
    const [frames, skeletons] = readHeader(buffer, 'MRMB');
    if (skeletons !== scratch.skeletons.length) {
      throw new Error(`the block has ${skeletons} skeletons, ` +
        `the scene ${scratch.skeletons.length}`);
    }
    // Checked before memory is allocated: a frame has at least 24 bytes.
    if (frames > buffer.byteLength / 24) throw new Error('the block is truncated');
    this.frames = frames;
    this.view = new DataView(buffer);
    this.starts = new Float64Array(frames);
    let at = BLOCK_HEADER_BYTES;
    for (let i = 0; i < frames; ++i) {
      this.starts[i] = at;
      at = decodeFrame(this.view, at, scratch);
      if (at < 0) throw new Error(`the block's frame ${i} is truncated or belongs to another scene`);
    }
  }

  /** Reads frame i. Precondition: 0 <= i < frames. */
  read(i: number, into: SceneFrame): void {
    decodeFrame(this.view, this.starts[i], into);
  }
}

/** The labelled points of a recording. */
export class PointBlock {
  readonly frames: number;
  readonly points: number;
  private readonly view: DataView;

  /** Throws an Error with the cause. */
  constructor(buffer: ArrayBuffer) {
    [this.frames, this.points] = readHeader(buffer, 'MRPB');
    if (BLOCK_HEADER_BYTES + this.frames * this.points * POINT_BYTES > buffer.byteLength) {
      throw new Error('the block of points is truncated');
    }
    this.view = new DataView(buffer);
  }

  /** Returns the first frame with a point; 0 if there is none. */
  firstSeen(): number {
    for (let k = 0; k < this.frames * this.points; ++k) {
      if (!Number.isNaN(this.view.getFloat32(BLOCK_HEADER_BYTES + k * POINT_BYTES, true))) {
        return Math.floor(k / this.points);
      }
    }
    return 0;
  }

  /** Reads the points of frame i: x y z into `p_in_world` (NaN: absent), indices into SOURCES
   *  into `source`. Precondition: 0 <= i < frames; room for all points. */
  read(i: number, p_in_world: Float32Array, source: Uint8Array): void {
    const start = BLOCK_HEADER_BYTES + i * this.points * POINT_BYTES;
    for (let k = 0; k < this.points; ++k) {
      const at = start + k * POINT_BYTES;
      p_in_world[3 * k] = this.view.getFloat32(at, true);
      p_in_world[3 * k + 1] = this.view.getFloat32(at + 4, true);
      p_in_world[3 * k + 2] = this.view.getFloat32(at + 8, true);
      source[k] = Math.min(this.view.getUint8(at + 12), 2);
    }
  }
}
