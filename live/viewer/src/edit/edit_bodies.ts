// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The bodies that frames of the edit belong to.

import type {PreviewWords, RenderedParts, RenderedWords} from '../protocol/edit_protocol';
import type {SceneWords, SkeletonWords} from '../protocol/protocol';

export type Bodies = readonly SkeletonWords[];

/** Returns the bodies of a result or a preview, which are those of the scene unless it has its
 *  own; null: it belongs to another scene. */
export function bodiesOf(parts: RenderedParts, scene: SceneWords | null): Bodies | null {
  const own = (parts as PreviewWords).skeletons;
  if (own) return own;
  const isOther = (parts as RenderedWords).type === 'rendered' && parts.scene !== scene?.revision;
  return isOther ? null : scene?.skeletons ?? null;
}

/** Each preview has its own copy of the bodies. */
export function sameBodies(a: Bodies, b: Bodies): boolean {
  return a === b || JSON.stringify(a) === JSON.stringify(b);
}
