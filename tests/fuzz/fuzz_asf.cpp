// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// A skeleton, and behind the first '@' a motion of it.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/assert.h"
#include "core/pose.h"
#include "recordings/motion/asf.h"

namespace {

using namespace marey;
using namespace marey::recordings;

void check(const Motion& motion) {
  for (const Pose& pose : motion.poses) {
    MAREY_ASSERT(pose.parent_from_joint.size() == motion.skeleton.joints.size());
    if (motion.skeleton.joints.size() > 1000) return;
    for (const RigidTransform& joint : world_from_joints(motion.skeleton, pose)) {
      MAREY_ASSERT(std::isfinite(glm::dot(joint.translation, joint.translation)));
      MAREY_ASSERT(std::abs(glm::length(joint.rotation) - 1.0) < 1e-6);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t end = text.find('@');
  const Result<AsfSkeleton> skeleton = parse_asf(text.substr(0, end), "fuzz.asf");
  if (!skeleton || end == std::string_view::npos) return 0;
  MAREY_ASSERT(skeleton->channels.size() == skeleton->skeleton.joints.size());
  const Result<AmcMotion> motion = parse_amc(text.substr(end + 1), "fuzz.amc", *skeleton);
  if (motion) check(motion->motion);
  return 0;
}
