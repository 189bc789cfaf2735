// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "dynamics/balance/zero_moment_point.h"
#include <glm/vec2.hpp>

namespace marey::dynamics {

/// Corners of one support area in ground projection (X, Z): a convex polygon, in order,
/// in either direction. Empty: no support. One or two corners: a point or a line.
using SupportPolygon = std::vector<glm::dvec2>;

/// Returns the distance of a point outside of a support area; negative inside: distance
/// to the nearest edge. Points and lines have no inside. nullopt: no support. [m] Linear
/// in corners.
[[nodiscard]] std::optional<double> distance_outside(std::span<const glm::dvec2> corners,
                                                     const glm::dvec2& p_xz_m);

/// Returns a point inside of a support area: `p_xz_m` if it is further inside than the
/// margin, else a point near the nearest one on the edge, moved by the margin towards the
/// mean of the corners. Without support: `p_xz_m`. Linear in corners.
[[nodiscard]] glm::dvec2 moved_inside(std::span<const glm::dvec2> corners,
                                      const glm::dvec2& p_xz_m,
                                      double margin_m);

/// Zero moment points of a motion against its support areas.
struct ZmpFigures {
  int loaded_frames = 0;       ///< There is a zero moment point.
  int supported_frames = 0;    ///< Loaded, and there is a support area.
  int inside_frames = 0;       ///< Supported, and the point is inside or on the edge.
  double worst_outside_m = 0;  ///< Largest distance outside; 0 if there is none.
  std::optional<int> worst_frame{};

  /// Returns the share of the supported frames; 1 without such frames.
  [[nodiscard]] double inside_share() const {
    return supported_frames > 0 ? static_cast<double>(inside_frames) / supported_frames
                                : 1.0;
  }
};

/// Compares each frame. Precondition: both have the same length.
[[nodiscard]] ZmpFigures zmp_figures(std::span<const GroundReaction> reactions,
                                     std::span<const SupportPolygon> supports);

}  // namespace marey::dynamics
