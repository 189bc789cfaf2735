// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "benchmarks/adaptation/posture_solver.h"
#include "core/constraint.h"
#include "retarget/adapt/adapter.h"

namespace marey {

/// Returns the id of the constraint of goal `k` in a marey_constraints().
[[nodiscard]] std::string goal_id(std::size_t k);

/// The goals as constraints: contact with a point, or a support where the goal is
/// planted. All of the same importance.
[[nodiscard]] ConstraintSet marey_constraints(const PostureProblem& problem,
                                              double precision_m);

/// An Adapter as a solver. Its references need no loading, and what it hands out is a
/// Pose, so that all of its work is timed. Where the problem wants balance, so do the
/// options, horizontally. Precondition: the character and the options are sound.
[[nodiscard]] std::unique_ptr<PostureSolver> make_marey_solver(
    const PostureProblem& problem,
    const retarget::AdaptOptions& options,
    double precision_m = 1e-3);

}  // namespace marey
