// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/motion.h"

namespace marey::live {

/// Poses that came when they came, as a motion at a steady rate.
class MotionResampler {
 public:
  /// Poses whose time does not grow are passed over. Precondition: finite, and of a clock
  /// that is ours (SenderClock): the motion is as long as the times are apart.
  void add(double time_s, const Pose& pose);
  [[nodiscard]] std::size_t size() const { return poses_.size(); }

  /// From the first to the last, in between on the shorter way from each to the next.
  /// nullopt with fewer than two. Precondition: rate above 0; poses of the skeleton.
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
