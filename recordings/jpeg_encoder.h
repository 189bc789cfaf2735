// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "core/result.h"

namespace marey::recordings {

/// How uncompressed pixels lie in memory.
enum class RawLayout {
  kYuyv,  ///< Y U Y V, two bytes a pixel; chroma for every second pixel.
  kNv12,  ///< A plane of Y, then one of U V for every second pixel and row.
  kGrey,  ///< A plane of Y.
};

/// Pictures of a camera that does not compress, as JPEG of high quality: brightness is
/// kept as it is, to within a few grey values. One thread at a time.
class JpegEncoder {
 public:
  /// `stride`: bytes per row of the first plane. Errors (kInternal): libavcodec has no
  /// such encoder. Preconditions: positive even width; positive height, even for kNv12;
  /// a stride that holds a row.
  [[nodiscard]] static Result<JpegEncoder> create(RawLayout layout,
                                                  int width_px,
                                                  int height_px,
                                                  int stride);
  JpegEncoder(JpegEncoder&&) noexcept;
  JpegEncoder& operator=(JpegEncoder&&) noexcept;
  ~JpegEncoder();

  /// Valid until the next call; empty when `raw` is too short for a picture, or cannot be
  /// encoded.
  [[nodiscard]] std::span<const std::byte> encode(std::span<const std::byte> raw);

 private:
  struct Impl;
  explicit JpegEncoder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace marey::recordings
