// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Small camera pictures (docs/formats/page.md, kind 2).

export const THUMBNAIL_KIND = 2;
const HEADER_BYTES = 8;
const TAG_BYTES = 36;

export interface SeenTag {
  id: number;
  /** x y of four corners, in pixels of the original picture. */
  corners_px: number[];
}

export interface Thumbnail {
  camera: number;
  /** Size of the original picture. */
  width_px: number;
  height_px: number; tags: SeenTag[]; jpeg: Uint8Array<ArrayBuffer>;
}

/** Returns null if the message is truncated. */
export function decodeThumbnail(buffer: ArrayBuffer): Thumbnail | null {
  if (buffer.byteLength < HEADER_BYTES) return null;
  const view = new DataView(buffer);
  const count = view.getUint16(6, true);
  const end = HEADER_BYTES + count * TAG_BYTES;
  if (view.getUint8(0) !== THUMBNAIL_KIND || end > buffer.byteLength) return null;
  const tags = Array.from({length: count}, (_, i) => {
    const at = HEADER_BYTES + i * TAG_BYTES;
    return {id: view.getInt32(at, true), corners_px: Array.from({length: 8}, (__, k) =>
      view.getFloat32(at + 4 + 4 * k, true))};
  });
  return {
    camera: view.getUint8(1),
    width_px: view.getUint16(2, true),
    height_px: view.getUint16(4, true),
    tags,
    jpeg: new Uint8Array(buffer, end),
  };
}
