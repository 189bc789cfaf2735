// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/transform.h"

namespace marey::reconstruct {

/// Computes b_from_a that brings `p_in_a` nearest to `p_in_b`: least squares of the
/// distances with `weights` (Horn 1987, "Closed-form solution of absolute orientation
/// using unit quaternions"). For points on a line, the turn about it is arbitrary.
/// Preconditions: equal numbers of points, at least one; the weights' sum above 0.
[[nodiscard]] RigidTransform align(std::span<const glm::dvec3> p_in_a,
                                   std::span<const glm::dvec3> p_in_b,
                                   std::span<const double> weights);

/// Computes the mean shape of points that move together: `frames` holds shape after
/// shape, each of weights.size() points. Its frame is approximately the first one's
/// world. Some rounds of align() and averaging. Precondition: whole shapes, at least one.
[[nodiscard]] std::vector<glm::dvec3> mean_shape(std::span<const glm::dvec3> frames,
                                                 std::span<const double> weights);

}  // namespace marey::reconstruct
