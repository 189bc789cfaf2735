// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "core/base/result.h"

namespace marey::recordings {

/// Memory layout of uncompressed pixels.
enum class RawLayout {
  kYuyv,  ///< Y U Y V, two bytes a pixel; chroma for every second pixel.
  kNv12,  ///< A plane of Y, then one of U V for every second pixel and row.
  kGrey,  ///< A plane of Y.
};

/// Encodes uncompressed camera frames as JPEG of high quality. Brightness is preserved to
/// within a few grey values. Not thread-safe.
class JpegEncoder {
 public:
  /// Creates an encoder. `stride`: bytes per row of the first plane. Errors (kInternal):
  /// no memory. Preconditions: positive even width; positive height, even for kNv12; a
  /// stride of at least one row.
  [[nodiscard]] static Result<JpegEncoder> create(RawLayout layout,
                                                  int width_px,
                                                  int height_px,
                                                  int stride);
  JpegEncoder(JpegEncoder&&) noexcept;
  JpegEncoder& operator=(JpegEncoder&&) noexcept;
  ~JpegEncoder();

  /// Encodes one frame. The result is valid until the next call; empty if `raw` is too
  /// short for a frame, or cannot be encoded.
  [[nodiscard]] std::span<const std::byte> encode(std::span<const std::byte> raw);

 private:
  struct Impl;
  explicit JpegEncoder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace marey::recordings
