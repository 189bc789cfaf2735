// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/skeleton.h"
#include "retarget/body/body_map.h"

namespace marey::retarget {

/// The largest angle between the T-poses of two bodies that match_carriage() leaves, at
/// the trunk and at the neck. [rad]
inline constexpr double kKeptCarriage_rad = 0.052359877559829883;  // 3 degrees.

/// Turns trunk and neck of an avatar's T-pose towards the source's.
///
/// Rigs of one body differ in the places of hip, shoulder and neck joints, and in their
/// lean at rest: necks by up to 20 degrees. Rotations relative to the T-pose keep that
/// difference in every frame. Its part beyond kKeptCarriage_rad is removed: the vertebrae
/// and collar bones turn together until the line from mid-hip to mid-shoulder is within
/// that angle of the source's, and the neck's joints until the line from neck to head is.
/// Head, hips, arms and legs keep their own T-poses.
///
/// Nothing changes if one of the bodies lacks these bones, if the two are less than
/// kKeptCarriage_rad apart, or if they are more than 60 degrees apart: the rest pose is
/// then no standing posture. Linear in joints.
/// Precondition: `avatar` is map_body()'s of `body`, `source` is map_body()'s of
/// `source_body`.
void match_carriage(const Skeleton& source_body,
                    const BodyMap& source,
                    const Skeleton& body,
                    BodyMap& avatar);

}  // namespace marey::retarget
