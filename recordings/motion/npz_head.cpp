// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/motion/npz_head.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/humanoid.h"
#include "recordings/base/motion_limits.h"

namespace marey::recordings {

Status read_npz_rate(NpzInput& in, Motion& motion) {
  const auto rate = in.number<double>("rate_hz", "<f8");
  if (!rate) return rate.error();
  if (!(*rate >= kMinRateHz && *rate <= kMaxRateHz)) {
    return in.fail("rate_hz", "the rate is not between 0.1 and 2000 Hz");
  }
  const auto first = in.number<std::int64_t>("first_frame", "<i8");
  if (!first) return first.error();
  constexpr std::int64_t kMaxFirstFrame = 1'000'000'000;
  if (*first < -kMaxFirstFrame || *first > kMaxFirstFrame) {
    return in.fail("first_frame", "the number is not that of a frame");
  }
  motion.rate = FrameRate{*rate};
  motion.first_frame = static_cast<int>(*first);
  return Done{};
}

Status read_npz_joints(NpzInput& in, Skeleton& skeleton) {
  const auto count = in.length("joint_names");
  if (!count) return count.error();
  const std::size_t joints = *count;
  if (joints == 0 || joints > kMaxJoints) {
    return in.fail("joint_names", "there are no joints, or too many");
  }
  const auto names = in.texts("joint_names", joints);
  const auto bones = in.texts("human_bones", joints);
  const auto parents = in.array("parents", "<i4", {joints});
  if (!names) return names.error();
  if (!bones) return bones.error();
  if (!parents) return parents.error();
  std::vector<std::size_t> level(joints, 1);
  for (std::size_t i = 0; i < joints; ++i) {
    Joint joint;
    joint.name = (*names)[i];
    joint.bone = human_bone((*bones)[i]);
    const auto parent = parents->at<std::int32_t>(i);
    if (i == 0 ? parent != -1 : parent < 0 || std::cmp_greater_equal(parent, i)) {
      return in.fail("parents",
                     "joint " + std::to_string(i) + " has no parent before it");
    }
    if (i > 0) {
      joint.parent = JointIndex{parent};
      level[i] = level[static_cast<std::size_t>(parent)] + 1;
    }
    if (level[i] > kMaxSkeletonDepth) {
      return in.fail("parents", "joints are nested too deeply");
    }
    skeleton.joints.push_back(std::move(joint));
  }
  return Done{};
}

}  // namespace marey::recordings
