// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/motion.h"
#include "core/result.h"
#include "retarget/identify_bones.h"

namespace marey::retarget {

/// Makes a pose the rest of a motion's skeleton, turned about the vertical to face along
/// an axis and moved level above the origin. Poses keep their places.
/// Precondition: the pose has as many rotations as the skeleton joints; the motion has
/// poses, which say where up is.
void rest_as_pose(Motion& motion, const FoundBones& found, const Pose& pose);

/// Gives a skeleton the rest rotations of another one with joints of the same names:
/// those of its joints that the other has.
/// Errors (bad input), with the joint: a human bone's joint is not in the other skeleton,
/// or its bone lies in another direction of the joint's frame.
[[nodiscard]] Status rest_as_other(const Skeleton& other,
                                   const FoundBones& found,
                                   Motion& motion);

}  // namespace marey::retarget
