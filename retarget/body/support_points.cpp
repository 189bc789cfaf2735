// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/support_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace marey::retarget {

std::vector<glm::dvec3> support_points(std::span<const glm::dvec3> points) {
  constexpr int kDirections = 128;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<std::size_t> chosen;
  if (points.empty()) return {};
  for (int i = 0; i < kDirections; ++i) {
    // A spiral from pole to pole that covers all directions evenly.
    const double y = 1.0 - (2.0 * i + 1.0) / kDirections;
    const double across = std::sqrt(1.0 - y * y);
    const glm::dvec3 way(across * std::cos(golden * i), y, across * std::sin(golden * i));
    std::size_t best = 0;
    for (std::size_t k = 1; k < points.size(); ++k) {
      if (glm::dot(points[k], way) > glm::dot(points[best], way)) best = k;
    }
    if (std::ranges::find(chosen, best) == chosen.end()) chosen.push_back(best);
  }
  std::vector<glm::dvec3> out;
  for (const std::size_t k : chosen) out.push_back(points[k]);
  return out;
}

}  // namespace marey::retarget
