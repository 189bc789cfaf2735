// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: thickness of the soft tissue around bones.

#include <glm/vec3.hpp>

#include "core/humanoid.h"
#include "core/skeleton.h"

namespace marey::reconstruct {

/// Returns the distance of a point in a bone's frame from the soft tissue around that
/// bone: 0 within it. The soft tissue is a capsule from the bone's origin to its far end,
/// as thick as that of a stout person of this stature, with a marker's height above the
/// skin. Segments that move together (a foot and its toes) are one. [m]
[[nodiscard]] double outside_soft_tissue_m(HumanBone bone,
                                           const glm::dvec3& p_in_bone,
                                           const Proportions& proportions,
                                           double stature_m);

}  // namespace marey::reconstruct
