// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/constraints/constraint_targets.h"

#include <variant>

#include "retarget/constraints/constraint_projections.h"

namespace marey::retarget {
namespace {

using Vec = Vec3<double>;

glm::dvec3 plain(const Vec& v) {
  return {v.x, v.y, v.z};
}

Vec vec(const glm::dvec3& v) {
  return lanes<double>(v);
}

/// One function per type of goal.
struct Conversion {
  const GoalPlaces& places;

  [[nodiscard]] PointTargets bring_to(const Vec& target) const {
    PointTargets targets;
    targets.add({places.p_in_world, plain(target)});
    return targets;
  }
  [[nodiscard]] PointTargets keep_from(const glm::dvec3& from, double distance_m) const {
    return bring_to(at_distance(vec(places.p_in_world), vec(from), distance_m));
  }
  void add_levers(const glm::dquat& wanted, PointTargets& targets) const {
    const RigidTransform& now = places.world_from_segment;
    const Vec joint = vec(now.translation);
    for (const Vec& lever : {Vec{kLever_m, 0.0, 0.0}, Vec{0.0, kLever_m, 0.0}}) {
      targets.add({plain(lever_end(joint, lanes<double>(now.rotation), lever)),
                   plain(lever_end(joint, lanes<double>(wanted), lever))});
    }
  }

  PointTargets operator()(const DistanceToPoint& goal) const {
    return keep_from(goal.p_in_world, goal.distance_m);
  }
  PointTargets operator()(const DistanceToBody& goal) const {
    return keep_from(places.other_in_world, goal.distance_m);
  }
  PointTargets operator()(const DistanceToConstraint& goal) const {
    return keep_from(places.other_in_world, goal.distance_m);
  }
  PointTargets operator()(const AllowedSpace& goal) const {
    return bring_to(
        inside(vec(places.p_in_world), vec(goal.min_in_world), vec(goal.max_in_world)));
  }
  PointTargets operator()(const ForbiddenSpace& goal) const {
    return bring_to(
        outside(vec(places.p_in_world), vec(goal.min_in_world), vec(goal.max_in_world)));
  }
  PointTargets operator()(const SegmentOrientation& goal) const {
    PointTargets targets;
    add_levers(goal.world_from_t_pose, targets);
    return targets;
  }
  PointTargets operator()(const Support& goal) const {
    PointTargets targets =
        bring_to(vec(goal.footprint_in_world.value_or(places.footprint_in_world)));
    add_levers(goal.world_from_t_pose.value_or(places.footprint_world_from_t_pose),
               targets);
    return targets;
  }
};

}  // namespace

PointTargets targets_of(const Goal& goal, const GoalPlaces& places) {
  return std::visit(Conversion{places}, goal);
}

}  // namespace marey::retarget
