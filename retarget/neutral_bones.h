// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/motion.h"
#include "core/skeleton.h"
#include "retarget/identify_bones.h"

namespace marey::retarget {

/// What the motion says of each joint, summed over its frames.
struct Evidence {
  /// Sums of joint_from_parent rotations.
  std::vector<glm::dmat3> joint_from_parent;
  /// Of the upper and the lower bone of each limb: the elbow's or knee's hinge, times the
  /// sine of the bend, in the bone's own frame.
  std::array<std::array<glm::dvec3, 2>, 4> hinge{};
  double frames = 0.0;
};

/// One pass over the frames. Precondition: hips, thighs and feet are found.
[[nodiscard]] Evidence evidence_of(const Motion& motion, const FoundBones& found);

/// The T-pose of rest_as_t_pose(): the rotation of each joint's frame in marey's axes.
/// `foot_pitch_rad` as in NamedNeutral.
[[nodiscard]] std::vector<glm::dquat> t_pose_of_bones(const Skeleton& skeleton,
                                                      const FoundBones& found,
                                                      const Evidence& evidence,
                                                      double foot_pitch_rad);

}  // namespace marey::retarget
