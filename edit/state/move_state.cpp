// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/move_state.h"

#include <cmath>
#include <variant>

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

namespace marey::edit {
namespace {

/// Half extents, along the world's axes, of a turned box.
glm::dvec3 turned_half(const glm::dquat& turn, const glm::dvec3& half) {
  const glm::dmat3 m = glm::mat3_cast(turn);
  return glm::abs(m[0]) * half.x + glm::abs(m[1]) * half.y + glm::abs(m[2]) * half.z;
}

struct GoalMover {
  const RigidTransform& new_from_old;

  void operator()(DistanceToPoint& goal) const {
    goal.p_in_world = new_from_old * goal.p_in_world;
  }
  void operator()(DistanceToBody& /*goal*/) const {}
  void operator()(DistanceToConstraint& /*goal*/) const {}
  void operator()(AllowedSpace& goal) const {
    const glm::dvec3 centre =
        new_from_old * (0.5 * (goal.min_in_world + goal.max_in_world));
    const glm::dvec3 half =
        turned_half(new_from_old.rotation, 0.5 * (goal.max_in_world - goal.min_in_world));
    goal = {centre - half, centre + half};
  }
  void operator()(ForbiddenSpace& goal) const {
    const glm::dvec3 centre =
        new_from_old * (0.5 * (goal.min_in_world + goal.max_in_world));
    const glm::dvec3 half = 0.5 * (goal.max_in_world - goal.min_in_world);
    goal = {centre - half, centre + half};
  }
  void operator()(SegmentOrientation& goal) const {
    goal.world_from_t_pose =
        glm::normalize(new_from_old.rotation * goal.world_from_t_pose);
  }
  void operator()(Support& goal) const {
    if (goal.footprint_in_world) {
      goal.footprint_in_world = new_from_old * *goal.footprint_in_world;
    }
    if (goal.world_from_t_pose) {
      goal.world_from_t_pose =
          glm::normalize(new_from_old.rotation * *goal.world_from_t_pose);
    }
  }
};

}  // namespace

RigidTransform turn_about(const glm::dvec3& pivot_in_world,
                          double turn_rad,
                          const glm::dvec3& target_in_world) {
  RigidTransform out;
  out.rotation = glm::angleAxis(turn_rad, glm::dvec3(0.0, 1.0, 0.0));
  out.translation = target_in_world - out.rotation * pivot_in_world;
  return out;
}

void move_constraint(const RigidTransform& new_from_old, Constraint& constraint) {
  std::visit(GoalMover{new_from_old}, constraint.goal);
}

void move_state(const RigidTransform& new_from_old, EditState& state) {
  for (Pose& pose : state.motion.poses) {
    pose.root_in_world = new_from_old * pose.root_in_world;
    pose.parent_from_joint[0] =
        glm::normalize(new_from_old.rotation * pose.parent_from_joint[0]);
  }
  for (Constraint& constraint : state.constraints.constraints) {
    move_constraint(new_from_old, constraint);
  }
  for (FootContacts& foot : state.contacts.feet) {
    foot.ankle_height_m += new_from_old.translation.y;
    foot.ball_height_m += new_from_old.translation.y;
  }
}

}  // namespace marey::edit
