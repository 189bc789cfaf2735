// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "core/motion.h"
#include "retarget/bones/found_bones.h"

namespace marey::retarget {

/// The axis of a file's world that is used as up, because its rest pose does not stand.
struct MotionUp {
  glm::dvec3 axis{0.0, 1.0, 0.0};  ///< Unit, one of six.
  /// Share of the frames in which the direction from feet to hips is within 45 degrees of
  /// the axis.
  double share = 0.0;
};

/// Returns +Y, as most files have it, if hips are above feet along it in a tenth of the
/// frames: a body that lies most of the time must not change the up axis. Otherwise
/// returns the axis along which they are in most frames, if in half of them or more; else
/// +Y.
/// Precondition: the motion has poses; both legs and the hips are found. Cost: linear in
/// frames times joints.
[[nodiscard]] MotionUp up_of_motion(const Motion& motion, const FoundBones& found);

}  // namespace marey::retarget
