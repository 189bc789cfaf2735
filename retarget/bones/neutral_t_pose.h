// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "core/motion.h"
#include "retarget/bones/found_bones.h"
#include "retarget/bones/named_neutrals.h"

namespace marey::retarget {

/// Makes a T-pose the rest of a motion's skeleton, standing along `up` (unit, in the
/// file's world), facing along an axis, feet on the floor. The motion's world positions
/// stay the same: they do not depend on the rest pose.
///
/// The T-pose follows from the bones. Arms and legs are straight along their bones. The
/// vertebrae, the neck and the head stand along their own axis that is nearest to their
/// bone. Feet are flat, with the slope of an average foot unless `known` states a better
/// one. Left is where the hips have their left leg and the chest its left arm. A bone's
/// rotation about itself is one of a few choices: an axis of its own, or for upper arms
/// and thighs a multiple of 30 degrees from one. The motion only decides between these
/// choices, by the bend of elbows and knees and by the relative rotation of adjacent
/// bones. So all motions of a skeleton get the same rest.
///
/// Precondition: the motion has poses; both legs and the hips are found. Cost: linear in
/// frames times joints.
void set_rest_t_pose(Motion& motion,
                     const FoundBones& found,
                     const glm::dvec3& up,
                     const NamedNeutral* known = nullptr);

}  // namespace marey::retarget
