// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/character.h"
#include "core/character_spec.h"
#include "core/result.h"
#include "core/skeleton.h"
#include "retarget/body_map.h"

namespace marey::retarget {

/// The masses of a body. The trunk is shared out over hips and vertebrae, however many,
/// by height; their common centre of mass in the T-pose is the table's. Clavicles and
/// neck weigh nothing of their own, toes are the foot's. What the skeleton lacks is
/// carried by what it hangs on: an arm without a hand goes on straight by an average
/// hand.
///
/// Errors: weigh_segments()'s.
/// Precondition: `map` was made from `skeleton`.
[[nodiscard]] Result<std::vector<PointMass>> place_masses(const Skeleton& skeleton,
                                                          const BodyMap& map,
                                                          const MassSpec& spec);

}  // namespace marey::retarget
