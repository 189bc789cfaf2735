// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/resample.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"

namespace marey {
namespace {

/// An instant this near to a frame is the frame's: rates are rounded to doubles. [frames]
constexpr double kSame = 1e-6;

Pose between(const Pose& a, const Pose& b, double part) {
  MAREY_ASSERT(a.parent_from_joint.size() == b.parent_from_joint.size());
  Pose pose;
  pose.root_in_world = glm::mix(a.root_in_world, b.root_in_world, part);
  pose.parent_from_joint.reserve(a.parent_from_joint.size());
  for (std::size_t i = 0; i < a.parent_from_joint.size(); ++i) {
    pose.parent_from_joint.push_back(
        glm::normalize(glm::slerp(a.parent_from_joint[i], b.parent_from_joint[i], part)));
  }
  return pose;
}

}  // namespace

Motion resample(const Motion& motion, FrameRate rate) {
  MAREY_ASSERT(motion.rate.hz > 0.0 && rate.hz > 0.0);
  Motion out{motion.skeleton, rate, 0, {}};
  if (motion.poses.empty()) return out;
  const double new_per_old = rate.hz / motion.rate.hz;
  const double old_per_new = motion.rate.hz / rate.hz;
  const double first = motion.first_frame;
  const double last = first + static_cast<double>(motion.poses.size() - 1);
  // The same tolerance, converted to new frames.
  const double same = kSame * std::max(1.0, new_per_old);
  const double from = std::ceil(first * new_per_old - same);
  const double to = std::floor(last * new_per_old + same);
  out.first_frame = static_cast<int>(from);
  for (double k = from; k <= to; ++k) {
    const double at = std::clamp(k * old_per_new - first, 0.0, last - first);
    const double nearest = std::round(at);
    if (std::abs(at - nearest) <= kSame) {
      out.poses.push_back(motion.poses[static_cast<std::size_t>(nearest)]);
      continue;
    }
    const auto before = static_cast<std::size_t>(at);
    out.poses.push_back(between(motion.poses[before],
                                motion.poses[before + 1],
                                at - static_cast<double>(before)));
  }
  return out;
}

}  // namespace marey
