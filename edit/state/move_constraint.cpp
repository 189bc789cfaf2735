// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/move_constraint.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include <glm/geometric.hpp>

namespace marey::edit {
namespace {

/// Moves one goal; returns false if the result is another space.
struct GoalMover {
  const RigidTransform& moved_from_old;

  bool operator()(DistanceToPoint& goal) const {
    goal.p_in_world = moved_from_old * goal.p_in_world;
    return true;
  }
  bool operator()(DistanceToBody&) const { return true; }
  bool operator()(DistanceToConstraint&) const { return true; }
  bool operator()(AllowedSpace& goal) const {
    return move_space(goal.min_in_world, goal.max_in_world);
  }
  bool operator()(ForbiddenSpace& goal) const {
    return move_space(goal.min_in_world, goal.max_in_world);
  }
  bool operator()(SegmentOrientation& goal) const {
    goal.world_from_t_pose = moved_from_old.rotation * goal.world_from_t_pose;
    return true;
  }
  bool operator()(Support& goal) const {
    if (goal.footprint_in_world) {
      goal.footprint_in_world = moved_from_old * *goal.footprint_in_world;
    }
    if (goal.world_from_t_pose) {
      goal.world_from_t_pose = moved_from_old.rotation * *goal.world_from_t_pose;
    }
    return true;
  }

 private:
  bool move_space(glm::dvec3& low, glm::dvec3& high) const {
    const glm::dvec3 centre = 0.5 * (low + high);
    const glm::dvec3 shift = moved_from_old * centre - centre;
    low += shift;
    high += shift;
    constexpr double kTurn_rad = std::numbers::pi / 180.0;
    return glm::length(rotation_vector(moved_from_old.rotation)) <= kTurn_rad;
  }
};

}  // namespace

bool move_constraint(const RigidTransform& moved_from_old, Constraint& constraint) {
  return std::visit(GoalMover{moved_from_old}, constraint.goal);
}

double middle_s(const Constraint& constraint, double duration_s) {
  const Activation& active = constraint.activation;
  const double start = std::clamp(active.start_s.value_or(0.0), 0.0, duration_s);
  const double stop = std::clamp(active.stop_s.value_or(duration_s), start, duration_s);
  return 0.5 * (start + stop);
}

}  // namespace marey::edit
