// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/balance/support_polygon.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::dynamics {

std::optional<double> distance_outside(std::span<const glm::dvec2> corners,
                                       const glm::dvec2& p_xz_m) {
  if (corners.empty()) return std::nullopt;
  double nearest_m = std::numeric_limits<double>::max();
  bool has_left = false;
  bool has_right = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 a = corners[i];
    const glm::dvec2 along = corners[(i + 1) % corners.size()] - a;
    const glm::dvec2 off = p_xz_m - a;
    const double side = along.x * off.y - along.y * off.x;
    has_left |= side > 0.0;
    has_right |= side < 0.0;
    const double squared = glm::dot(along, along);
    const double at =
        squared > 0.0 ? std::clamp(glm::dot(off, along) / squared, 0.0, 1.0) : 0.0;
    nearest_m = std::min(nearest_m, glm::length(off - at * along));
  }
  const bool is_inside = corners.size() > 2 && has_left != has_right;
  return is_inside ? -nearest_m : nearest_m;
}

glm::dvec2 moved_inside(std::span<const glm::dvec2> corners,
                        const glm::dvec2& p_xz_m,
                        double margin_m) {
  const auto outside_m = distance_outside(corners, p_xz_m);
  if (!outside_m || *outside_m <= -margin_m) return p_xz_m;
  glm::dvec2 middle(0.0);
  for (const glm::dvec2& corner : corners) {
    middle += corner / static_cast<double>(corners.size());
  }
  glm::dvec2 out = p_xz_m;
  if (*outside_m > 0.0) {
    double nearest_m = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const glm::dvec2 a = corners[i];
      const glm::dvec2 along = corners[(i + 1) % corners.size()] - a;
      const double squared = glm::dot(along, along);
      const double at = squared > 0.0
                            ? std::clamp(glm::dot(p_xz_m - a, along) / squared, 0.0, 1.0)
                            : 0.0;
      const glm::dvec2 on_edge = a + at * along;
      if (glm::distance(on_edge, p_xz_m) >= nearest_m) continue;
      nearest_m = glm::distance(on_edge, p_xz_m);
      out = on_edge;
    }
  }
  const double way_m = glm::distance(out, middle);
  if (way_m <= margin_m) return middle;
  return out + margin_m / way_m * (middle - out);
}

ZmpFigures zmp_figures(std::span<const GroundReaction> reactions,
                       std::span<const SupportPolygon> supports) {
  MAREY_ASSERT(reactions.size() == supports.size());
  ZmpFigures out;
  for (std::size_t t = 0; t < reactions.size(); ++t) {
    if (!reactions[t].zmp_xz_m) continue;
    ++out.loaded_frames;
    const auto outside_m = distance_outside(supports[t], *reactions[t].zmp_xz_m);
    if (!outside_m) continue;
    ++out.supported_frames;
    if (*outside_m <= 0.0) ++out.inside_frames;
    if (*outside_m > out.worst_outside_m) {
      out.worst_outside_m = *outside_m;
      out.worst_frame = static_cast<int>(t);
    }
  }
  return out;
}

}  // namespace marey::dynamics
