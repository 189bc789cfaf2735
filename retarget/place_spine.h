// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include <glm/vec3.hpp>

#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/body_map.h"
#include "retarget/normalized_skeleton.h"

namespace marey::retarget {

/// Turns the vertebrae of `map` in the world: each as the posture's spine curves are at
/// its arc length, and then all of them, as little and as evenly as will do, so that neck
/// and shoulders lie where the posture's own spine puts them.
///
/// Where that is: the posture's vertebrae are rigid, so along the way from hips to neck
/// its turn is constant bone by bone; the end lies at the integral of that turn over the
/// way as this body's bones go at rest. On a body whose spine differs in nothing but the
/// number of its bones it is the place where the posture's own neck was.
///
/// Three vertebrae and more bring it there with the last one turned as the posture says,
/// to a millimetre; where that would leave more than 0.2 percent of the spine's length
/// (bones too short for so sharp a bend), and with one or two vertebrae, neck and
/// shoulders get the least sum of squares from their places, the last vertebra turning
/// too. A few steps of Newton's method on a damped system, as many in every frame:
/// continuous in the posture. Nothing is changed of a body that the posture fits.
/// Allocates nothing; half a microsecond where there is something to change, a tenth
/// where there is not.
void place_spine(const NormalizedPose& pose,
                 const BodyMap& map,
                 std::span<RigidTransform> world_from_joint);

/// From where an expanded body's left and right arm hang to where the posture's spine has
/// them: what place_spine() had to leave. In the world [m]; zero for arms that do not
/// hang on the last vertebra, collar bones between or not.
[[nodiscard]] std::array<glm::dvec3, 2> shoulders_missing_m(
    const NormalizedPose& pose,
    const Skeleton& body,
    const BodyMap& map,
    std::span<const RigidTransform> world_from_joint);

/// As place_spine() for the joints from the neck to the head, where the posture or the
/// body has more than one: the head lies where the posture's own neck puts it. What turns
/// the neck about itself is shared out over its joints.
void place_neck(const NormalizedPose& pose,
                const BodyMap& map,
                std::span<RigidTransform> world_from_joint);

}  // namespace marey::retarget
