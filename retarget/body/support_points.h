// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace marey::retarget {

/// Returns the support points of a point set in 128 directions, spread evenly over the
/// sphere: an approximate convex hull, used to find the lowest vertex of a skin. Each
/// point is returned once, in the order of the directions. However the set is turned, its
/// lowest support point is above its lowest point by less than 2 % of the local radius.
/// Linear in points.
[[nodiscard]] std::vector<glm::dvec3> support_points(std::span<const glm::dvec3> points);

}  // namespace marey::retarget
