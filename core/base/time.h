// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cmath>

namespace marey {

/// A point on a clock that the owner names. For frames of a trial: since the trial's
/// start, on the clock of its first camera. For a device's frames and events: the
/// kernel's monotonic clock.
using Timestamp = std::chrono::nanoseconds;

/// Frames per second of a constant-rate stream.
struct FrameRate {
  double hz = 30.0;
};

/// Returns the middle of the exposure of frame `frame`: frame / rate + offset. The frame
/// index is the only clock that video containers keep faithfully. Rounded to the
/// nanosecond.
[[nodiscard]] inline Timestamp frame_time(int frame,
                                          FrameRate rate,
                                          Timestamp offset = Timestamp{0}) {
  return Timestamp{std::llround(1e9 * frame / rate.hz)} + offset;
}

[[nodiscard]] inline double seconds(Timestamp time) {
  return 1e-9 * static_cast<double>(time.count());
}

[[nodiscard]] inline Timestamp from_seconds(double time_s) {
  return Timestamp{std::llround(1e9 * time_s)};
}

/// Source of a camera's time offset.
enum class ClockSource {
  kReference,  ///< The first camera's: its clock is the trial's.
  kGiven,      ///< Given in the session.
  kEstimated,  ///< Estimated from the detections.
};

}  // namespace marey
