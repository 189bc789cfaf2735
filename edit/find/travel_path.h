// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "edit/state/edit_state.h"
#include <glm/vec2.hpp>

namespace marey::edit {

/// The way of a body over the floor, without the sway of its steps: one entry per frame.
/// Two-dimensional points are world X and Z.
struct TravelPath {
  std::vector<glm::dvec2> origin_m;
  /// Direction of travel: 0 is +Z, a quarter turn is +X. Continuous; interpolated while
  /// the body stands.
  std::vector<double> heading_rad;
  std::vector<double> way_m;  ///< Length of the path since the first frame.
  double cycle_s = 1.0;       ///< Duration of two steps; 1 s if no foot stands twice.
};

/// Computes the path of the hips joint, low-passed over a cycle (Gleicher 2001, section
/// 3): a cubic smoothing spline with half power at half the frequency of the cycle. A
/// straight path stays straight up to its ends. Linear in frames.
[[nodiscard]] TravelPath find_travel_path(const EditState& state);

/// Returns the largest distance of the path's points from each other, along one of eight
/// directions, over these frames. [m]
[[nodiscard]] double extent_m(const TravelPath& path, const FrameRange& frames);

/// Returns the unit vector of a heading, X and Z.
[[nodiscard]] glm::dvec2 direction_of(double heading_rad);

/// Returns a vector turned about the vertical: +Z turns towards +X.
[[nodiscard]] glm::dvec2 turned(const glm::dvec2& v, double turn_rad);

}  // namespace marey::edit
