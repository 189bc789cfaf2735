// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/motion.h"
#include "retarget/bones/found_bones.h"

namespace marey::retarget {

/// Sums over the frames of a motion that determine the rest pose of the bones.
struct NeutralEvidence {
  /// Sums of joint_from_parent rotations.
  std::vector<glm::dmat3> joint_from_parent;
  /// For the upper and the lower bone of each limb: the hinge axis of the elbow or knee,
  /// times the sine of the bend, in the bone's own frame.
  std::array<std::array<glm::dvec3, 2>, 4> hinge{};
  double frames = 0.0;
};

/// Computes the sums in one pass over the frames.
/// Precondition: hips, thighs and feet are found.
[[nodiscard]] NeutralEvidence evidence_of(const Motion& motion, const FoundBones& found);

}  // namespace marey::retarget
