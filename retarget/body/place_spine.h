// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include <glm/vec3.hpp>

#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"
#include "retarget/body/normalized_pose.h"

namespace marey::retarget {

/// Turns the vertebrae of `map` in the world: each to the posture's spine curves at its
/// arc length, and then all of them, as little and as evenly as possible, so that neck
/// and shoulders reach the positions that the posture's own spine determines.
///
/// These positions: the posture's vertebrae are rigid, so its rotation is constant bone
/// by bone along the path from hips to neck; the end is the integral of that rotation
/// over the path along this body's bones at rest. If the body's spine differs only in the
/// number of its bones, the result is the position of the posture's own neck.
///
/// Three vertebrae and more reach it, to a millimetre, with the last one turned as in the
/// posture. Where that would leave more than 0.2 percent of the spine's length (bones too
/// short for so sharp a bend), and with one or two vertebrae, the sum of squared
/// distances of neck and shoulders from their positions is minimized, and the last
/// vertebra turns too. Takes a fixed number of steps of Newton's method on a damped
/// system: continuous in the posture. A body that the posture fits is not changed.
/// Allocates nothing; half a microsecond with a change, a tenth without.
void place_spine(const NormalizedPose& pose,
                 const BodyMap& map,
                 std::span<RigidTransform> world_from_joint);

/// Returns the residual of place_spine(): from the attachment of an expanded body's left
/// and right arm to the position that the posture's spine determines. In the world [m];
/// zero for arms that are not below the last vertebra, with or without collar bones
/// between.
[[nodiscard]] std::array<glm::dvec3, 2> shoulders_missing_m(
    const NormalizedPose& pose,
    const Skeleton& body,
    const BodyMap& map,
    std::span<const RigidTransform> world_from_joint);

/// Applies place_spine() to the joints from the neck to the head, where the posture or
/// the body has more than one: the head reaches the position that the posture's own neck
/// determines. The neck's rotation about itself is distributed over its joints.
void place_neck(const NormalizedPose& pose,
                const BodyMap& map,
                std::span<RigidTransform> world_from_joint);

}  // namespace marey::retarget
