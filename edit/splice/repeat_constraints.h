// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/find/planar_match.h"

#include "core/constraint.h"

namespace marey::edit {

/// Returns the constraints of `count` copies of a cycle. Copy k is `period_s` later and
/// moved by `step` against copy k - 1; its ids have the next free numbers.
///
/// At a seam a constraint that is fully active at the end of a copy continues the one
/// that is so at the start of the next copy, if both are on the same point with the same
/// goal to within 10 mm and 6 degrees: they become one. Others that last beyond a seam
/// end or begin there; if both are on one segment, they cross-fade in 0.1 s. Before the
/// first and after the last copy times are the source's. Quadratic in the constraints of
/// a cycle.
[[nodiscard]] ConstraintSet repeat_constraints(const ConstraintSet& once,
                                               const PlanarMove& step,
                                               double period_s,
                                               int count);

}  // namespace marey::edit
