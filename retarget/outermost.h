// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace marey::retarget {

/// Of many points those that are furthest in some of 128 directions, spread evenly over
/// the sphere, each once, in the order of directions: what stands for a skin where all
/// that is asked is how low it is. Whichever way it is turned, the lowest of them is
/// above the lowest of all by less than a fiftieth of what is round there. Linear in
/// points.
[[nodiscard]] std::vector<glm::dvec3> outermost(std::span<const glm::dvec3> points);

}  // namespace marey::retarget
