// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/reach_target.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace marey::engine {
namespace {

bool is_finite_vector(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Name of the value that is wrong; nullptr: none.
const char* wrong_target_value(const ReachTarget& target) {
  if (!is_finite_vector(target.p_in_world)) return "place";
  if (!is_finite_vector(target.velocity_m_s)) return "velocity";
  if (!is_finite_vector(target.turn_rad_s)) return "angular velocity";
  if (target.approach) {
    const double length = glm::length(*target.approach);
    if (!std::isfinite(length) || length < 1e-9) return "approach direction";
  }
  if (target.speed_m_s && !(std::isfinite(*target.speed_m_s) && *target.speed_m_s >= 0)) {
    return "arrival speed";
  }
  if (target.world_from_hand) {
    const double length = glm::length(*target.world_from_hand);
    if (!std::isfinite(length) || length < 1e-9) return "hand orientation";
  }
  return nullptr;
}

}  // namespace

bool is_usable(const ReachTarget& target) {
  return wrong_target_value(target) == nullptr;
}

Status check_target(const ReachTarget& target) {
  const char* value = wrong_target_value(target);
  if (value == nullptr) return Done{};
  return bad_input("reach",
                   "the target's " + std::string(value) +
                       " is not a number, zero where it needs a direction, or negative",
                   "give finite numbers");
}

}  // namespace marey::engine
