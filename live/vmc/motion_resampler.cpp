// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/motion_resampler.h"

#include <cmath>

#include <glm/common.hpp>

#include "core/base/assert.h"

namespace marey::live {
namespace {

Pose between(const Pose& a, const Pose& b, double share) {
  Pose out;
  out.root_in_world = glm::mix(a.root_in_world, b.root_in_world, share);
  for (std::size_t j = 0; j < a.parent_from_joint.size(); ++j) {
    out.parent_from_joint.push_back(
        glm::slerp(a.parent_from_joint[j], b.parent_from_joint[j], share));
  }
  return out;
}

}  // namespace

void MotionResampler::add(double time_s, const Pose& pose) {
  MAREY_ASSERT(std::isfinite(time_s));
  if (!poses_.empty() && time_s <= poses_.back().time_s) return;
  poses_.push_back({time_s, pose});
}

std::optional<Motion> MotionResampler::at_rate(const Skeleton& skeleton,
                                               FrameRate rate) const {
  MAREY_ASSERT(rate.hz > 0.0);
  if (poses_.size() < 2) return std::nullopt;
  Motion motion{skeleton, rate, 0, {}};
  const double begin_s = poses_.front().time_s;
  // Tolerance in frames, so that rounding does not drop the last frame.
  constexpr double kSlack = 1e-6;
  const auto frames = static_cast<std::size_t>(
      std::floor((poses_.back().time_s - begin_s) * rate.hz + kSlack));
  std::size_t next = 1;
  for (std::size_t f = 0; f <= frames; ++f) {
    const double at_s = begin_s + static_cast<double>(f) / rate.hz;
    while (next + 1 < poses_.size() && poses_[next].time_s < at_s) ++next;
    const ReceivedPose& a = poses_[next - 1];
    const ReceivedPose& b = poses_[next];
    const double share = (at_s - a.time_s) / (b.time_s - a.time_s);
    motion.poses.push_back(between(a.pose, b.pose, glm::clamp(share, 0.0, 1.0)));
  }
  return motion;
}

}  // namespace marey::live
