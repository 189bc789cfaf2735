// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/body_map.h"
#include "retarget/normalized_skeleton.h"

namespace marey::retarget {

/// Whether the spine of a body can leave shoulders elsewhere than the source's has them:
/// not where both share the way from hips to neck out alike.
[[nodiscard]] bool spines_differ(const BodyMap& source, const BodyMap& avatar);

/// Wrists go where they would be if the shoulders were where the posture's spine has
/// them: a spine of one or two vertebrae, or one bent more sharply than its bones can be,
/// leaves these millimetres to the arms. Elbows stay in their half-plane; an arm does not
/// stretch beyond its reach (aim_arm()). True when `pose` has changed and is to be
/// expanded again. `world_from_joint` is what expand() gave for `pose` and `body`.
/// Continuous in the posture; allocates nothing.
bool keep_wrists(const Skeleton& body,
                 const BodyMap& map,
                 std::span<const RigidTransform> world_from_joint,
                 NormalizedPose& pose);

}  // namespace marey::retarget
