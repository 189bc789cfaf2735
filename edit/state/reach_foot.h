// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/pose.h"
#include "core/skeleton.h"
#include "retarget/body/body_map.h"
#include "retarget/feet/foot_place.h"

namespace marey::edit {

/// Turns thigh, shank, foot and toes so that the foot is at a place, whatever joints
/// without a bone lie between them and the hips: the knee bends in its own plane, then
/// the leg turns as little as possible. Returns the remaining distance of the ankle. [m]
/// Two passes of forward kinematics. Precondition: `map` was made from the skeleton.
double reach_foot(const Skeleton& skeleton,
                  const retarget::BodyMap& map,
                  int side,
                  const retarget::FootPlace& place,
                  Pose& pose);

}  // namespace marey::edit
