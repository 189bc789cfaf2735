// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Frames of the edited motion: a whole result, and the part that a preview has rendered.

import {MotionBlock} from '../protocol/decode_blocks';
import {SceneFrame} from '../protocol/decode_frame';
import type {OutputWords, Span} from '../protocol/edit_protocol';
import type {SkeletonWords} from '../protocol/protocol';
import {Instant} from '../timeline/instant';
import {Playback} from '../timeline/playback';
import {fetched} from '../timeline/reel';

/** Frames `span[0]` to `span[1]` of a motion. */
export interface MotionPart {block: MotionBlock; span: Span}

export class EditReel {
  readonly playback = new Playback();
  private instant = new Instant([]);
  private whole: MotionPart | null = null;
  private preview: MotionPart | null = null;
  private loading = new AbortController();

  /** The shown instant, after compose(). */
  get shown(): SceneFrame {
    return this.instant.shown;
  }

  /** Sets the bodies. Removes all frames. */
  setSkeletons(skeletons: readonly SkeletonWords[]): void {
    this.instant = new Instant(skeletons);
    this.whole = null;
    this.preview = null;
  }

  /** Fetches the frames of an output of these bodies, without using them yet. null: frames that
   *  were requested later replace them, or `failed` received the cause. */
  async fetch({block, span}: OutputWords, skeletons: readonly SkeletonWords[],
    failed: (problem: string) => void): Promise<MotionPart | null> {
    this.loading.abort();
    this.loading = new AbortController();
    const {signal} = this.loading;
    try {
      const bytes = await fetched(block, signal);
      return signal.aborted ? null
        : {block: new MotionBlock(bytes, new SceneFrame(skeletons)), span};
    } catch (problem) {
      if (!signal.aborted) failed(String(problem));
      return null;
    }
  }

  /** Shows these frames. The instant stays, as far as the motion has it. */
  setWhole(part: MotionPart, {frames, rate_hz}: OutputWords): void {
    const {playback} = this;
    const time_s = playback.time / playback.rate_hz;
    const changed = rate_hz !== playback.rate_hz;
    playback.rate_hz = rate_hz;
    playback.setRange(0, frames - 1);
    if (changed) playback.seek(Math.round(time_s * rate_hz));
    this.whole = part;
    this.preview = null;
  }

  /** Shows these frames where they exist; null: only those of setWhole(). */
  setPreview(part: MotionPart | null): void {
    this.preview = part;
  }

  /** Forgets the preview. A change that was made is shown with it, around the shown instant,
   *  until its result arrives. Returns whether there was one. */
  dropPreview(): boolean {
    const isDropped = this.preview !== null;
    this.preview = null;
    return isDropped;
  }

  /** True if the preview has the shown frame, or there is none. */
  get hasPreviewedFrame(): boolean {
    return !this.preview || contains(this.preview, this.playback.frame);
  }

  /** Sets `shown` to the instant of the playback. Returns false if there is nothing to show. */
  compose(): boolean {
    const {time, frame} = this.playback;
    return this.instant.compose(time, frame, this.read);
  }

  private readonly read = (i: number, into: SceneFrame): boolean => {
    const part = this.preview && contains(this.preview, i) ? this.preview : this.whole;
    if (!part || !contains(part, i)) return false;
    part.block.read(i - part.span[0], into);
    return true;
  };
}

function contains({span, block}: MotionPart, i: number): boolean {
  return i >= span[0] && i - span[0] < block.frames;
}
