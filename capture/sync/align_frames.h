// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/base/time.h"

namespace marey::capture {

/// Times of one camera's frames, in their order, on the common clock.
struct CameraTimes {
  CameraId camera{};
  std::vector<Timestamp> times;
};

struct AlignedCamera {
  CameraId camera{};
  /// The recorded frame at each instant; nullopt for a missing frame.
  std::vector<std::optional<int>> recorded;
  /// Mean delay of its frames relative to the instants.
  Timestamp offset{0};
  int surplus = 0;  ///< Frames beyond the first of an instant; they are omitted.
  /// 95th percentile of the deviation of its frames' times from instant + offset.
  Timestamp spread{0};
};

struct FrameAlignment {
  FrameRate rate;  ///< Instant k is k / rate after the first.
  std::vector<AlignedCamera> cameras;
};

/// Returns the frame rate of a stream that may lack frames: the slope of a straight line
/// through its times, for the rate with the smallest deviations. Returns nullopt for
/// fewer than three frames, or for times that do not increase.
[[nodiscard]] std::optional<FrameRate> measured_rate(std::span<const Timestamp> times);

/// Returns true if the number of instants from the first frame to the last is so large
/// that a time stamp must be wrong: more than ten instants per frame, and more than a few
/// minutes.
[[nodiscard]] bool reach_too_far(std::span<const CameraTimes> cameras, FrameRate rate);

/// Matches the frames of several cameras by time. Builds a common grid of instants, in
/// phase with the first camera, and selects for each camera the frame nearest to each
/// instant (minus the camera's own constant offset, at most half a period). All cameras
/// get the same number of instants; the first is that of the first frame. `rate` nullopt:
/// the measured rate of the fastest cameras.
/// Returns nullopt if no camera has a measurable rate, or the times reach_too_far().
/// Preconditions: at least one camera; times ascend, and their differences do not
/// overflow.
[[nodiscard]] std::optional<FrameAlignment> align_frames(
    std::span<const CameraTimes> cameras, std::optional<FrameRate> rate = {});

}  // namespace marey::capture
