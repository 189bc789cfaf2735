// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/result.h"
#include "core/character.h"
#include "core/character_spec.h"
#include "core/skeleton.h"
#include "retarget/body/body_map.h"

namespace marey::retarget {

/// Distributes the masses of a body over its joints. The trunk is distributed over hips
/// and vertebrae, of any number, by height; their common centre of mass in the T-pose is
/// the table's. Clavicles and neck have no mass of their own; toes are part of the foot.
/// The mass of a missing part is carried by its parent: an arm without a hand is extended
/// straight by an average hand.
///
/// Each mass has the inertia of its segment, with the longitudinal axis along the segment
/// in the T-pose. The parts of the trunk together have the inertia of the table's trunk
/// in the T-pose.
///
/// Errors: those of weigh_segments().
/// Precondition: `map` was made from `skeleton`.
[[nodiscard]] Result<std::vector<PointMass>> place_masses(const Skeleton& skeleton,
                                                          const BodyMap& map,
                                                          const MassSpec& spec);

}  // namespace marey::retarget
