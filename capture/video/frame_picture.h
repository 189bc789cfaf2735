// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace marey::capture {

struct PictureOptions {
  int max_width_px = 960;  ///< Wider images are reduced; never enlarged.
  int jpeg_quality = 80;   ///< 1 to 100.
};

/// A frame for display, in colour.
struct FramePicture {
  int frame = 0;
  int width_px = 0;  ///< Size of the picture.
  int height_px = 0;
  /// A pixel (u, v) of the frame is at ((u + 0.5) * scale - 0.5, (v + 0.5) * scale - 0.5)
  /// in the picture.
  double scale = 1.0;
  std::vector<std::byte> jpeg;
};

/// Returns pictures of some frames of a video or a folder of images, in the order of
/// `frames` (any order, with repeats). One pass: the cost of decoding grows with the
/// largest frame number. `name` is the recording's name in messages; the path if empty.
/// Errors (kBadInput): as for open_frames(); a frame that the recording does not have.
/// Preconditions: frames >= 0; options in their ranges.
[[nodiscard]] Result<std::vector<FramePicture>> read_pictures(
    const std::filesystem::path& path,
    std::span<const int> frames,
    const PictureOptions& options = {},
    const std::string& name = {});

/// Calls read_pictures() for one frame and returns its JPEG.
[[nodiscard]] Result<std::vector<std::byte>> jpeg_of_frame(
    const std::filesystem::path& path, int frame, const PictureOptions& options = {});

}  // namespace marey::capture
