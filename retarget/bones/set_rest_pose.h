// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/motion.h"
#include "retarget/bones/found_bones.h"

namespace marey::retarget {

/// Makes a pose the rest pose of a motion's skeleton, turned about `up` (unit, in the
/// file's world) to face along an axis and moved level above the origin. The motion's
/// world positions stay the same. Precondition: the pose has as many rotations as the
/// skeleton joints.
void set_rest_pose(Motion& motion,
                   const FoundBones& found,
                   const glm::dvec3& up,
                   const Pose& pose);

/// Copies the rest rotations of another skeleton to the joints of the same names. Errors
/// (bad input), with the joint: a human bone's joint is not in the other skeleton, or its
/// bone lies in another direction of the joint's frame.
[[nodiscard]] Status copy_rest_pose(const Skeleton& other,
                                    const FoundBones& found,
                                    const glm::dvec3& up,
                                    Motion& motion);

}  // namespace marey::retarget
