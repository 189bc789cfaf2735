// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"
#include "retarget/body/normalized_skeleton.h"

namespace marey::retarget {

/// Returns true if the spine of a body can leave shoulders at other positions than the
/// source's. False if both divide the path from hips to neck in the same way.
[[nodiscard]] bool spines_differ(const BodyMap& source, const BodyMap& avatar);

/// Moves wrists to where they would be with the shoulders at the positions of the
/// posture's spine. A spine with one or two vertebrae, or one that is bent more sharply
/// than its bones permit, leaves these millimetres to the arms. Elbows stay in their
/// half-plane, and arms within their reach (aim_arm()). Returns true if `pose` has
/// changed and must be expanded again. `world_from_joint` is the result of expand() for
/// `pose` and `body`. Continuous in the posture; allocates nothing.
bool keep_wrists(const Skeleton& body,
                 const BodyMap& map,
                 std::span<const RigidTransform> world_from_joint,
                 NormalizedPose& pose);

}  // namespace marey::retarget
