// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/constraint.h"
#include "core/skeleton.h"
#include "retarget/constraints/constraint_error.h"

namespace marey::retarget {

/// Rejects cycles of constraints that keep their distances from each other. Precondition:
/// all named constraints exist, and none names itself.
[[nodiscard]] Refusal check_circles(const ConstraintSet& set);

/// Rejects contradictions: boxes and supports of one point without a common position
/// while all are fully active; supports of one foot whose distance differs from that of
/// its points; two distances between the same two points. Precondition: each constraint
/// alone is valid.
[[nodiscard]] Refusal check_contradictions(const ConstraintSet& set,
                                           const Skeleton& skeleton);

}  // namespace marey::retarget
