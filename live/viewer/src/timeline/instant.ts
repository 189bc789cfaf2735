// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// An instant between two frames.

import {SceneFrame} from '../protocol/decode_frame';
import type {SkeletonWords} from '../protocol/protocol';
import {blendFrames} from '../scene/posed_skeleton';

/** Reads frame i. Returns false if there is none. */
export type ReadFrame = (i: number, into: SceneFrame) => boolean;

export class Instant {
  /** The instant, after compose(). */
  readonly shown: SceneFrame;
  private readonly before: SceneFrame;
  private readonly after: SceneFrame;

  constructor(skeletons: readonly Pick<SkeletonWords, 'joints'>[]) {
    this.shown = new SceneFrame(skeletons);
    this.before = new SceneFrame(skeletons);
    this.after = new SceneFrame(skeletons);
  }

  /** Sets `shown` to `time`, a frame and its fraction; without the frame after it, to the
   *  nearest frame `frame`. Returns false if there is nothing to show. */
  compose(time: number, frame: number, read: ReadFrame): boolean {
    const {shown, before, after} = this;
    const low = Math.floor(time);
    if (low === time || !read(low + 1, after)) return read(frame, shown);
    if (!read(low, before)) return false;
    shown.frame = before.frame;
    shown.sent_s = before.sent_s;
    for (let i = 0; i < shown.skeletons.length; ++i) {
      blendFrames(shown.skeletons[i], before.skeletons[i], after.skeletons[i], time - low);
    }
    return true;
  }
}
