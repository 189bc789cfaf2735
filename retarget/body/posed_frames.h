// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/motion.h"
#include "core/pose.h"
#include "core/transform.h"

namespace marey::retarget {

/// World frames of all joints over a whole motion: forward kinematics, computed once.
class PosedFrames {
 public:
  /// Precondition: every pose has one entry per joint.
  explicit PosedFrames(const Motion& motion)
      : joints_(motion.skeleton.joints.size()),
        count_(motion.poses.size()),
        world_from_joint_(joints_ * motion.poses.size()) {
    for (std::size_t t = 0; t < count_; ++t) {
      world_from_joints(motion.skeleton,
                        motion.poses[t],
                        std::span(world_from_joint_).subspan(t * joints_, joints_));
    }
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  /// One frame per joint.
  /// Precondition: t < count().
  [[nodiscard]] std::span<const RigidTransform> operator[](std::size_t t) const {
    return std::span(world_from_joint_).subspan(t * joints_, joints_);
  }

 private:
  std::size_t joints_;
  std::size_t count_;
  std::vector<RigidTransform> world_from_joint_;
};

}  // namespace marey::retarget
