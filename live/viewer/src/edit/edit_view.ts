// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The shown motion, as tools of the edit page see and change it.

import type {Change, EditDocument} from './edit_document';
import type {OpStep, OpWords, OutputWords, PreviewParts} from '../protocol/edit_protocol';

/** The shown motion and the way to change it. Implemented by the page. */
export interface EditView {
  readonly document: EditDocument;
  /** Operations that are applied to the shown motion; null: all of them. A user looks at the
   *  motion before or after one operation with it. */
  readonly until: number | null;
  /** The shown motion; null: none was received. During a preview it stays the one that the
   *  gesture began on. */
  readonly output: OutputWords | null;
  /** Its index in the results. */
  readonly outputIndex: number;
  /** The shown instant. [frames] */
  readonly time: number;
  /** Shows the motion with a change that is not made, as in a drag. `until` as above; by
   *  default, the same operations as now and inserted ones are applied. */
  preview(change: Change, until?: number | null): void;
  /** Makes the change, and shows its result. Returns whether it was done. */
  commit(change: Change): Promise<boolean>;
  /** Ends a preview without a change. */
  cancel(): void;
}

/** Index at which an operation is inserted that receives the shown motion. A last retarget
 *  stays last; it changes no times. */
export function insertIndex(ops: readonly OpWords[], until: number | null): number {
  const end = until ?? ops.length;
  return end > 0 && ops[end - 1]?.do.startsWith('retarget@') ? end - 1 : end;
}

/** As insertIndex(), for an operation in places of the shown body. After a retarget, these are
 *  the avatar's, which has other lengths, so that the operation comes after it. */
export function placeIndex(ops: readonly OpWords[], until: number | null): number {
  return until ?? ops.length;
}

/** Returns the number of operations up to index `until` after a change. Operations inserted at
 *  `until` are included. */
export function untilAfter(steps: readonly OpStep[], until: number): number {
  let end = until;
  for (const step of steps) {
    if ('insert' in step) end += step.insert <= end ? 1 : 0;
    else if ('remove' in step) end -= step.remove < end ? 1 : 0;
    else if ('move' in step) {
      if (step.move < end && step.to >= end) end -= 1;
      else if (step.move >= end && step.to < end) end += 1;
    }
  }
  return end;
}

/** Frames before and after the shown one that a preview contains. */
const PREVIEW_FRAMES = 150;

/** Returns which part of a changed motion is rendered. `until`: as in EditView.preview(). */
export function previewParts(steps: readonly OpStep[],
  view: Pick<EditView, 'until' | 'outputIndex' | 'time'>, until?: number | null): PreviewParts {
  const frame = Math.round(view.time);
  const end = until !== undefined ? until
    : view.until === null ? null : untilAfter(steps, view.until);
  return {until: end, output: view.outputIndex,
    span: [Math.max(frame - PREVIEW_FRAMES, 0), frame + PREVIEW_FRAMES]};
}
