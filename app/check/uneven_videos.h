// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Videos whose own frame times are not those of the rate that they are taken for.

#include <optional>
#include <span>
#include <string>

#include "app/check/recording_troubles.h"
#include "capture/sync/align_frames.h"
#include "core/base/result.h"
#include "core/detection.h"
#include "recordings/session/session.h"

namespace marey::app {

struct UnevenVideo {
  capture::CameraTimes own;
  double worst_s = 0.0;  ///< How far a frame is from the steady rate.
  /// It runs evenly, at another rate than it was held against.
  std::optional<FrameRate> other_rate;
};

/// nullopt of a video that is steady at `rate`, or does not tell.
[[nodiscard]] std::optional<UnevenVideo> uneven_video(const recordings::TrialVideo& video,
                                                      FrameRate rate);

/// The finding in words, without its consequence.
[[nodiscard]] std::string how_uneven(const UnevenVideo& video, FrameRate rate);

/// Whether frames can be matched by number, as a trial's `frames` or its fps ask for.
/// Errors (kBadInput): an uneven video without an fps; one that runs evenly at another
/// rate than the fps while others do not; declared slow motion that contradicts the
/// videos' rates. All alike at another rate is a failure, unless it is declared.
[[nodiscard]] Status check_even(const recordings::Trial& trial,
                                std::span<const CameraDetections> found,
                                RecordingTroubles& troubles);

}  // namespace marey::app
