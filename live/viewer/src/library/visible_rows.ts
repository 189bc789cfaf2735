// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The part of a long list that is visible.

export interface VisibleRows {first: number; last: number}

/** Returns the rows that are at least partly visible, with `spare` more on both sides. last is
 *  first - 1 if there are none. */
export function visibleRows(top_px: number, height_px: number, row_px: number, count: number,
  spare: number): VisibleRows {
  const first = Math.max(0, Math.floor(top_px / row_px) - spare);
  const last = Math.min(count - 1, Math.ceil((top_px + height_px) / row_px) - 1 + spare);
  return {first: Math.min(first, Math.max(count, 0)), last: Math.max(last, first - 1)};
}

/** Returns the place of a list at which a row is fully visible, as near as possible to the
 *  current one. */
export function scrolledTo(index: number, top_px: number, height_px: number,
  row_px: number): number {
  const start = index * row_px;
  if (start < top_px) return start;
  return Math.max(top_px, start + row_px - height_px);
}
