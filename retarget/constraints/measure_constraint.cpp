// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/constraints/measure_constraint.h"

#include <variant>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/pose.h"
#include "core/transform.h"
#include "retarget/constraints/constraint_targets.h"
#include "retarget/constraints/resolve_segment.h"

namespace marey::retarget {

CarriedPoint carried_point(const Character& character, const BodyPoint& point) {
  const auto joint = resolve_segment(character.skeleton, point.segment);
  MAREY_ASSERT(joint.has_value());
  CarriedPoint out;
  out.joint = *joint;
  out.t_pose_from_joint =
      character.t_pose_from_joint.empty()
          ? world_from_joints(character.skeleton,
                              rest_pose(character.skeleton))[index(*joint)]
                .rotation
          : character.t_pose_from_joint[index(*joint)];
  out.p_in_joint = glm::conjugate(out.t_pose_from_joint) * point.offset_in_t_pose;
  return out;
}

ConstraintMeasure::ConstraintMeasure(const Character& character,
                                     const Constraint& constraint,
                                     const ConstraintSet& set)
    : goal_(constraint.goal), point_(carried_point(character, constraint.point)) {
  if (const auto* body = std::get_if<DistanceToBody>(&goal_)) {
    other_ = carried_point(character, body->other);
  } else if (const auto* other = std::get_if<DistanceToConstraint>(&goal_)) {
    other_ = carried_point(character, set.find(other->other_id)->point);
  }
}

double max_met_error(const Constraint& constraint) {
  if (std::holds_alternative<SegmentOrientation>(constraint.goal)) {
    return (constraint.precision_m + kMeasured_m) / kLever_m;
  }
  const bool support = std::holds_alternative<Support>(constraint.goal);
  return (support ? kSupportPrecision_m : constraint.precision_m) + kMeasured_m;
}

bool is_met(const Constraint& constraint, const Shortfall& shortfall) {
  const bool turns = std::holds_alternative<SegmentOrientation>(constraint.goal);
  return (turns ? shortfall.rad : shortfall.m) <= max_met_error(constraint);
}

Shortfall ConstraintMeasure::shortfall(std::span<const RigidTransform> world_from_joint,
                                       const glm::dvec3& footprint_in_world) const {
  const RigidTransform& segment = world_from_joint[index(point_.joint)];
  GoalPlaces places;
  places.p_in_world = point_.in_world(world_from_joint);
  if (const auto* support = std::get_if<Support>(&goal_)) {
    return {glm::distance(places.p_in_world,
                          support->footprint_in_world.value_or(footprint_in_world)),
            0.0};
  }
  places.world_from_segment = {
      segment.rotation * glm::conjugate(point_.t_pose_from_joint), segment.translation};
  if (const auto* turned = std::get_if<SegmentOrientation>(&goal_)) {
    const glm::dquat left =
        turned->world_from_t_pose * glm::conjugate(places.world_from_segment.rotation);
    return {0.0, glm::length(rotation_vector(glm::normalize(left)))};
  }
  if (other_) places.other_in_world = other_->in_world(world_from_joint);
  const PointTargets targets = targets_of(goal_, places);
  const PointTarget& only = targets.all().front();
  return {glm::distance(only.p_in_world, only.target_in_world), 0.0};
}

}  // namespace marey::retarget
