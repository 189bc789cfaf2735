// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "app/adapt/adapt_body.h"
#include "core/constraint.h"
#include "retarget/adapt/adapt_motion.h"
#include "retarget/adapt/plan_supports.h"

namespace marey::app {

/// Finds the missed constraints that more iterations would meet. Solves the worst frame
/// of each constraint that reached the limit, alone, with the default limit. Returns one
/// entry per constraint; all are 0 if the options already allow that many iterations.
/// Cost: one frame per constraint that reached the limit.
/// Precondition: `kept` is adapt_motion()'s result for these constraints, supports and
/// options.
[[nodiscard]] std::vector<char> try_more_iterations(
    const AdaptBody& body,
    std::span<const retarget::SupportTrack> supports,
    retarget::AdaptMotionOptions options,
    const ConstraintSet& constraints,
    std::span<const retarget::KeptConstraint> kept);

}  // namespace marey::app
