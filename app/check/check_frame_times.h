// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Detects videos whose frame times differ from the assumed constant rate.

#include <optional>
#include <span>
#include <string>

#include "capture/sync/align_frames.h"
#include "core/base/result.h"
#include "core/detection.h"
#include "core/finding.h"
#include "recordings/session/session.h"

namespace marey::app {

struct UnevenVideo {
  capture::CameraTimes own;
  double worst_s = 0.0;  ///< Largest distance of a frame from the rate.
  /// Constant rate of the video, if it has one that differs from the assumed rate.
  std::optional<FrameRate> other_rate;
};

/// Compares the frame times of a video with the constant rate `rate`. nullopt if all are
/// within a quarter of a period, or if the file has no usable times.
[[nodiscard]] std::optional<UnevenVideo> find_uneven_video(
    const recordings::TrialVideo& video, FrameRate rate);

/// Returns the finding as text, without its consequence.
[[nodiscard]] std::string describe_uneven_video(const UnevenVideo& video, FrameRate rate);

/// Checks that frames can be matched by number, in a trial with `frames` or with `fps`.
/// Errors (kBadInput): an uneven video in a trial without `fps`; a video with another
/// constant rate than `fps` while other videos have that of `fps`; declared slow motion
/// that contradicts the rates of the videos. If all videos have one other constant rate,
/// this is a poor finding, unless slow motion is declared.
[[nodiscard]] Status check_frame_times(const recordings::Trial& trial,
                                       std::span<const CameraDetections> found,
                                       std::vector<Finding>& findings);

}  // namespace marey::app
