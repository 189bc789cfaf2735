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

/// Finds of which missed constraints more iterations would help: solves the worst frame of
/// each that ran out, by itself, with the default number. One entry per constraint; all 0
/// where the options allow as many already. Costs a frame per constraint that ran out.
/// Precondition: `kept` is adapt_motion()'s of these constraints, supports and options.
[[nodiscard]] std::vector<char> try_more_iterations(
    const AdaptBody& body,
    std::span<const retarget::SupportTrack> supports,
    retarget::AdaptMotionOptions options,
    const ConstraintSet& constraints,
    std::span<const retarget::KeptConstraint> kept);

}  // namespace marey::app
