// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "capture/frame_source.h"
#include "capture/v4l2_device.h"
#include "core/result.h"

namespace marey::capture {

/// Turns a camera's pictures into grey ones. One camera and one thread for each.
class FrameDecoder {
 public:
  /// Messages call the camera `name`.
  explicit FrameDecoder(std::string name);
  FrameDecoder(FrameDecoder&&) noexcept;
  FrameDecoder& operator=(FrameDecoder&&) noexcept;
  ~FrameDecoder();

  /// The brightness of `frame`, packed as `settings` says, as picture `index` of its
  /// stream. Its pixels are ours and valid until the next call. Allocates nothing after
  /// the first of a size, libjpeg's own excepted. About 1.3 ms for 1280x720 MJPG.
  ///
  /// Errors (kDevice), after which the next frame may be fine: the driver says that the
  /// frame is damaged; it is too short or of another size; its JPEG is cut short or
  /// corrupt. Bytes too many, which some cameras send with every picture, do no harm, and
  /// neither do Huffman tables too few, which motion JPEG takes for granted.
  [[nodiscard]] Result<GrayFrame> decode(const RawFrame& frame,
                                         const DeviceSettings& settings,
                                         int index = 0);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace marey::capture
