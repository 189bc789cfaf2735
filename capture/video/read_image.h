// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <opencv2/core.hpp>

#include "capture/video/decode_png.h"
#include "capture/video/frame_source.h"
#include "core/base/result.h"

// Private to capture.
namespace marey::capture {

/// Reads a PNG (libpng) or JPEG (TurboJPEG), with 8 bits per channel, upright by the EXIF
/// mark of a JPEG. Grey is the brightness of a JPEG, and 0.299 R + 0.587 G + 0.114 B of a
/// PNG. `name` is used in messages. Errors (kBadInput): the file cannot be read
/// completely, or has more than 200 million pixels.
[[nodiscard]] Result<cv::Mat> read_image(const std::filesystem::path& path,
                                         ImageColours colours,
                                         const std::string& name);

/// Returns a view of an 8-bit single-channel matrix, which must outlive it.
[[nodiscard]] GrayFrame view_of(const cv::Mat& gray, int index);

/// Returns "1280x720".
[[nodiscard]] std::string size_text(int width_px, int height_px);
[[nodiscard]] inline std::string size_text(const cv::Size& size) {
  return size_text(size.width, size.height);
}

}  // namespace marey::capture
