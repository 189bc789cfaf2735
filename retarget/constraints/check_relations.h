// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/constraint.h"
#include "core/skeleton.h"
#include "retarget/constraints/constraint_error.h"

namespace marey::retarget {

/// Returns an error for cycles of constraints that keep their distances from each other.
/// Precondition: all named constraints exist, and none names itself.
[[nodiscard]] OptionalError check_cycles(const ConstraintSet& set);

/// Returns an error for contradictions: boxes and supports of one point without a common
/// position while all are fully active; supports of one foot whose distance differs from
/// that of its points; two distances between the same two points. Precondition: each
/// constraint alone is valid.
[[nodiscard]] OptionalError check_contradictions(const ConstraintSet& set,
                                                 const Skeleton& skeleton);

}  // namespace marey::retarget
