// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/time.h"

namespace marey::app {

/// When one camera's frames were taken, in their order, on the clock of all cameras.
struct CameraTimes {
  CameraId camera{};
  std::vector<Timestamp> times;
};

struct AlignedCamera {
  CameraId camera{};
  /// The recorded frame at each instant; nullopt where the camera took none.
  std::vector<std::optional<int>> recorded;
  /// Its frames are this much later than the instants, on average.
  Timestamp offset{0};
  int surplus = 0;  ///< Frames beyond the first of an instant: they are left out.
  /// Of its frames' times about instant + offset, 95th percentile.
  Timestamp spread{0};
};

struct Alignment {
  FrameRate rate;  ///< Instant k is k / rate after the first.
  std::vector<AlignedCamera> cameras;
};

/// Frames per second of a stream that may lack frames: the straight line through its
/// times, of the rate that they keep step with best. nullopt of fewer than three frames,
/// or times that do not grow.
[[nodiscard]] std::optional<FrameRate> measured_rate(std::span<const Timestamp> times);

/// Whether there are so many more instants than frames, from the first of them to the
/// last, that a time stamp must be wrong: more than ten for each frame, and a few
/// minutes'.
[[nodiscard]] bool reach_too_far(std::span<const CameraTimes> cameras, FrameRate rate);

/// Matches the frames of several cameras by time: a common grid of instants, in step with
/// the first camera, and for each camera the frame next to each of its instants (less its
/// own constant offset, of half a period at most). All cameras get as many instants, the
/// first being that of the first frame. `rate` nullopt: that of the fastest cameras, as
/// measured.
/// nullopt when no camera tells a rate, or the times reach_too_far(). Preconditions: at
/// least one camera; times ascend, and their differences are times.
[[nodiscard]] std::optional<Alignment> align_frames(std::span<const CameraTimes> cameras,
                                                    std::optional<FrameRate> rate = {});

}  // namespace marey::app
