// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include <glm/vec3.hpp>

#include "app/stage/figures/figure_body.h"
#include "app/stage/figures/worst_value.h"

namespace marey::app {

/// Distances of a point from a target that it can reach.
struct ReachedError {
  WorstValue error_mm;
  std::size_t beyond = 0;  ///< Steps in which the target is out of reach.
};

/// Returns the largest distance of a point of an arm from its target, in steps in which
/// the target is within the arm's length of its shoulder, as it is or as it was before
/// constraints. The length is that of both bones and the distance of the point from the
/// wrist. A point that is not of an arm always counts. `targets_in_world` has one place
/// per step. Linear.
[[nodiscard]] ReachedError reached_error_mm(const FigureBody& body,
                                            const FigurePoint& point,
                                            std::span<const glm::dvec3> targets_in_world,
                                            const FigureSpan& span);

/// Returns the smallest distance of a point from a target that moves. [mm]
[[nodiscard]] WorstValue clearance_mm(const FigureBody& body,
                                      const FigurePoint& point,
                                      std::span<const glm::dvec3> targets_in_world,
                                      const FigureSpan& span);

/// Returns the distance of a point from a target at an instant between the steps. [mm]
[[nodiscard]] double distance_at_mm(const FigureBody& body,
                                    const FigurePoint& point,
                                    std::span<const glm::dvec3> targets_in_world,
                                    double time_s);

}  // namespace marey::app
