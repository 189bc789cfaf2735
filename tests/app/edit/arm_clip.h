// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/humanoid.h"
#include "recordings/motion/bvh.h"

namespace marey::testing {

/// Writes a BVH of 121 frames at 60 Hz: a person stands and lowers the left arm evenly.
inline void write_arm_clip(const std::filesystem::path& file) {
  Motion motion{make_humanoid(average_proportions(1.75)), {60.0}, 0, {}};
  const auto arm = index(*motion.skeleton.find(HumanBone::kLeftUpperArm));
  for (int i = 0; i < 121; ++i) {
    Pose pose = rest_pose(motion.skeleton);
    pose.parent_from_joint[arm] = glm::angleAxis(-0.005 * i, glm::dvec3(0.0, 0.0, 1.0));
    motion.poses.push_back(std::move(pose));
  }
  const auto written = recordings::write_bvh(file, motion);
  ASSERT_TRUE(written) << written.error().message();
}

}  // namespace marey::testing
