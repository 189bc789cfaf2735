// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/constraint.h"
#include "core/skeleton.h"
#include "retarget/constraint_error.h"

namespace marey::retarget {

/// Constraints that keep their distances from each other in a circle.
/// Precondition: those that they name exist, and none names itself.
[[nodiscard]] Refusal check_circles(const ConstraintSet& set);

/// Boxes and supports of one point that leave it no place while all are fully active;
/// supports of one foot that are not as far apart as its points; two distances between
/// the same two points.
/// Precondition: each constraint alone is sound.
[[nodiscard]] Refusal check_contradictions(const ConstraintSet& set,
                                           const Skeleton& skeleton);

}  // namespace marey::retarget
