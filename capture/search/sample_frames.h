// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include <opencv2/core.hpp>

#include "capture/search/camera_input.h"
#include "capture/video/frame_source.h"
#include "core/base/frame_range.h"

// Private to capture: samples a few frames of a recording.
namespace marey::capture {

/// Calls `visit` with up to `count` frames, evenly spaced over the recording or its
/// `range`, in order, until it returns false. An unreadable recording gives fewer frames,
/// or none; damaged frames are skipped. Cost: decodes all frames in between.
void sample_frames(const std::filesystem::path& path,
                   const std::optional<FrameRange>& range,
                   int count,
                   const std::function<bool(const GrayFrame&)>& visit);

/// Returns a view of the frame's pixels, for OpenCV functions that only read them.
[[nodiscard]] cv::Mat matrix_of(const GrayFrame& frame);

}  // namespace marey::capture
