// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/cycle_paths.h"

#include <cmath>

namespace marey::edit {
namespace {

/// Mean of the unit vector (cos, sin) over turns from 0 to this one.
glm::dvec2 screw_factors(double turn_rad) {
  if (std::abs(turn_rad) < 1e-4) {
    const double squared = turn_rad * turn_rad;
    return {1.0 - squared / 6.0, 0.5 * turn_rad * (1.0 - squared / 12.0)};
  }
  return {std::sin(turn_rad) / turn_rad, (1.0 - std::cos(turn_rad)) / turn_rad};
}

/// Length of an arc over that of its chord.
double arc_over_chord(double turn_rad) {
  const double half = 0.5 * turn_rad;
  return std::abs(half) < 1e-6 ? 1.0 : half / std::sin(half);
}

}  // namespace

CycleScrew::CycleScrew(const PlanarMove& travel) : turn_rad_(travel.turn_rad) {
  // Inverse of the matrix that at() multiplies with.
  const glm::dvec2 f = screw_factors(turn_rad_);
  const double det = f.x * f.x + f.y * f.y;
  const glm::dvec2 s = travel.shift_xz_m;
  speed_ = {(f.x * s.x - f.y * s.y) / det, (f.y * s.x + f.x * s.y) / det};
}

PlanarMove CycleScrew::at(double share) const {
  const double turn = share * turn_rad_;
  const glm::dvec2 f = screw_factors(turn);
  return {turn,
          share * glm::dvec2(f.x * speed_.x + f.y * speed_.y,
                             f.x * speed_.y - f.y * speed_.x)};
}

CyclePaths::CyclePaths(const PlanarMove& travel,
                       CycleDrift drift,
                       const glm::dvec3& centre)
    : screw_(travel), middle_(screw_.at(0.5)), keeps_(drift == CycleDrift::kKeep) {
  const glm::dvec3 chord = travel(centre) - centre;
  line_m_ = arc_over_chord(travel.turn_rad) * glm::dvec2(chord.x, chord.z);
}

PlanarMove CyclePaths::new_path(double share) const {
  if (keeps_) return screw_.at(share);
  return {middle_.turn_rad, middle_.shift_xz_m + (share - 0.5) * line_m_};
}

}  // namespace marey::edit
