// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/base/time.h"

namespace marey::capture {

/// A view of one grey image, 8 bits a pixel, rows from the top. Does not own the pixels.
struct GrayFrame {
  const std::uint8_t* pixels = nullptr;
  int width_px = 0;
  int height_px = 0;
  int stride = 0;  ///< Bytes from one row to the next, >= width_px.
  int index = 0;   ///< Number of frames before this one in its stream.
  /// Damaged in the file and not decodable; the pixels are meaningless.
  bool damaged = false;
};

/// Properties of a stream that are known before its first frame.
struct StreamInfo {
  std::string name;  ///< Name for messages.
  int width_px = 0;
  int height_px = 0;
  std::optional<FrameRate> rate;       ///< nullopt if the stream does not contain it.
  std::optional<int> expected_frames;  ///< nullopt if it is unknown before the end.
  /// Clockwise rotation of every frame by the video's rotation mark; the size is after
  /// that. [degrees] 0, 90, 180 or 270.
  int turned_deg = 0;
};

/// Frames in the order of their exposure.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  [[nodiscard]] virtual const StreamInfo& info() const = 0;

  /// Returns the next frame, its pixels valid until the next call or the end of this
  /// object; nullopt at a regular end. Every frame is info().width_px by
  /// info().height_px, and `index` counts 0, 1, 2... Precondition: no call after an error
  /// or the end.
  [[nodiscard]] virtual Result<std::optional<GrayFrame>> next() = 0;

 protected:
  FrameSource() = default;
  FrameSource(const FrameSource&) = default;
  FrameSource& operator=(const FrameSource&) = default;
};

}  // namespace marey::capture
