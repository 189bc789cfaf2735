// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "capture/detect_videos.h"
#include "capture/frame_source.h"
#include "capture/look_for_boards.h"

// Private to capture/: looking at a few frames of a recording.
namespace marey::capture {

/// Calls `visit` with up to `count` frames from all over the recording, or `range` of it,
/// in their order, until it returns false. A recording that cannot be read has fewer, or
/// none; damaged frames are left out. Frames between them are decoded all the same.
void sample_frames(const std::filesystem::path& path,
                   const std::optional<FrameRange>& range,
                   int count,
                   const std::function<bool(const GrayFrame&)>& visit);

/// The frame's pixels, not copied; for OpenCV functions that only read them.
[[nodiscard]] cv::Mat matrix_of(const GrayFrame& frame);

/// look_for_boards() in frames that were sampled.
[[nodiscard]] std::optional<SeenInstead> look_at_frames(
    const std::vector<cv::Mat>& frames,
    const CalibrationTarget& target,
    std::span<const TagFamilyUse> worn);

}  // namespace marey::capture
