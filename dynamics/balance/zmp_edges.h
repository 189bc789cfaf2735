// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace marey::dynamics {

/// One edge of a support area: normal . p <= bound + slack. Without `of_zmp` it limits
/// the displacement itself.
struct ZmpEdge {
  std::size_t frame = 0;
  bool of_zmp = true;
  glm::dvec2 normal{0.0};
  double bound_m = 0.0;
  // Distance to the edge, elastic part, and their multipliers: all above 0.
  double room = 0.0;
  double slack = 0.0;
  double push = 0.0;
  double release = 0.0;
  // Newton step.
  double d_room = 0.0, d_slack = 0.0, d_push = 0.0, d_release = 0.0;
  // Work: residual of the constraint, elimination.
  double residual = 0.0, compliance = 0.0, offset = 0.0;
  // Products of the predictor's step.
  double correct_room = 0.0, correct_slack = 0.0;
};

/// Adds the edges of a frame's support area, moved inwards by a margin, at most a quarter
/// of the area's width. Returns false if the area has no inside.
bool add_support_edges(std::size_t frame,
                       std::span<const glm::dvec2> corners,
                       double margin_m,
                       std::vector<ZmpEdge>& out);

/// Adds limits of the displacement along X and Z.
void add_shift_limits(std::size_t frame, double limit_m, std::vector<ZmpEdge>& out);

}  // namespace marey::dynamics
