// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/motion.h"

namespace marey::live {

/// Resamples asynchronously received poses to a fixed rate.
class MotionResampler {
 public:
  /// Adds a pose. A pose that is not later than the one before is ignored. Precondition:
  /// `time_s` is finite and on the receiver's clock (SenderClock), because the duration
  /// of the motion is the difference of the times.
  void add(double time_s, const Pose& pose);
  [[nodiscard]] std::size_t size() const { return poses_.size(); }

  /// Returns the motion from the first to the last pose, interpolated: positions
  /// linearly, rotations by slerp along the shorter arc. nullopt with fewer than two
  /// poses. Precondition: rate above 0; all poses belong to the skeleton.
  [[nodiscard]] std::optional<Motion> at_rate(const Skeleton& skeleton,
                                              FrameRate rate) const;

 private:
  struct ReceivedPose {
    double time_s = 0.0;
    Pose pose;
  };
  std::vector<ReceivedPose> poses_;
};

}  // namespace marey::live
