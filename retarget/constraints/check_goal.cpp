// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/constraints/check_goal.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/in_quotes.h"
#include "core/nearest_word.h"
#include "retarget/constraints/resolve_segment.h"

namespace marey::retarget {
namespace {

/// Returns the valid segment names of this skeleton.
std::vector<std::string_view> segment_names(const Skeleton& skeleton) {
  std::vector<std::string_view> names;
  for (const Joint& joint : skeleton.joints) {
    if (joint.bone) names.push_back(name(*joint.bone));
    if (!joint.bone || name(*joint.bone) != joint.name) names.push_back(joint.name);
  }
  return names;
}

/// Returns the ends of the limbs that can stand.
std::vector<JointIndex> extremities(const Character& character) {
  std::vector<JointIndex> found;
  for (const BodyGroup& group : character.groups) {
    for (const BodyPart& part : group.parts) {
      if (!group.can_support || part.kind != PartKind::kLimb) continue;
      if (part.joints.size() == 3) found.push_back(part.joints[2]);
    }
  }
  return found;
}

OptionalError check_rotation(const Constraint& constraint, const glm::dquat& rotation) {
  constexpr double kUnit = 1e-6;  // Above the rounding errors of single precision.
  const double n = glm::length(rotation);
  if (std::abs(n - 1.0) <= kUnit) return std::nullopt;  // False for NaN.
  return constraint_error(constraint,
                          "the orientation is a quaternion of length " + digits(n),
                          "divide it by its length, which must be 1");
}

OptionalError check_box(const Constraint& constraint,
                        const glm::dvec3& low,
                        const glm::dvec3& high) {
  if (auto wrong = check_place(constraint, "box", low)) return wrong;
  if (auto wrong = check_place(constraint, "box", high)) return wrong;
  for (int axis = 0; axis < 3; ++axis) {
    if (low[axis] <= high[axis]) continue;
    return constraint_error(
        constraint,
        std::string("the box has its min above its max in ") + "xyz"[axis],
        "exchange " + digits(low[axis]) + " and " + digits(high[axis]));
  }
  return std::nullopt;
}

/// One function per type of goal.
struct GoalCheck {
  const Constraint& constraint;
  const ConstraintSet& set;
  const Character& character;

  [[nodiscard]] OptionalError check_distance(double distance_m) const {
    return check_number(constraint, "distance", distance_m, 0.0, kMaxLength_m);
  }
  /// The distance between two points of one segment is constant.
  [[nodiscard]] OptionalError check_apart(const BodyPoint& other) const {
    const Skeleton& skeleton = character.skeleton;
    if (resolve_segment(skeleton, constraint.point.segment) !=
        resolve_segment(skeleton, other.segment)) {
      return std::nullopt;
    }
    return constraint_error(constraint,
                            "its point and the one to keep a distance from are both of " +
                                in_quotes(other.segment) + ", and no posture changes it",
                            "name a point of another segment");
  }

  OptionalError operator()(const DistanceToPoint& goal) const {
    if (auto wrong = check_distance(goal.distance_m)) return wrong;
    return check_place(constraint, "target", goal.p_in_world);
  }
  OptionalError operator()(const DistanceToBody& goal) const {
    if (auto wrong = check_distance(goal.distance_m)) return wrong;
    if (auto wrong = check_point(constraint, goal.other, character.skeleton))
      return wrong;
    return check_apart(goal.other);
  }
  OptionalError operator()(const DistanceToConstraint& goal) const {
    if (auto wrong = check_distance(goal.distance_m)) return wrong;
    if (goal.other_id == constraint.id) {
      return constraint_error(constraint,
                              "it should keep a distance from itself",
                              "name another constraint, or a point of the body");
    }
    const Constraint* other = set.find(goal.other_id);
    if (other != nullptr) return check_apart(other->point);
    std::vector<std::string_view> ids;
    for (const Constraint& c : set.constraints) {
      if (c.id != constraint.id) ids.push_back(c.id);
    }
    return constraint_error(
        constraint,
        "there is no constraint " + in_quotes(goal.other_id) + " to keep a distance from",
        ids.empty() ? "add it" : suggestion(goal.other_id, ids));
  }
  OptionalError operator()(const AllowedSpace& goal) const {
    return check_box(constraint, goal.min_in_world, goal.max_in_world);
  }
  OptionalError operator()(const ForbiddenSpace& goal) const {
    return check_box(constraint, goal.min_in_world, goal.max_in_world);
  }
  OptionalError operator()(const SegmentOrientation& goal) const {
    return check_rotation(constraint, goal.world_from_t_pose);
  }
  OptionalError operator()(const Support& goal) const {
    if (goal.footprint_in_world) {
      if (auto wrong = check_place(constraint, "footprint", *goal.footprint_in_world)) {
        return wrong;
      }
    }
    if (goal.world_from_t_pose) {
      if (auto wrong = check_rotation(constraint, *goal.world_from_t_pose)) return wrong;
    }
    const std::vector<JointIndex> feet = extremities(character);
    const auto joint = resolve_segment(character.skeleton, constraint.point.segment);
    if (joint && std::find(feet.begin(), feet.end(), *joint) != feet.end()) {
      return std::nullopt;
    }
    std::vector<std::string_view> names;
    for (const JointIndex foot : feet) {
      const Joint& end = character.skeleton[foot];
      names.push_back(end.bone ? name(*end.bone) : std::string_view(end.name));
    }
    return constraint_error(constraint,
                            "a support stands on the end of a limb, and " +
                                in_quotes(constraint.point.segment) +
                                " is not one that can support",
                            names.empty() ? "let a group of the character support"
                                          : suggestion(constraint.point.segment, names));
  }
};

}  // namespace

OptionalError check_point(const Constraint& constraint,
                          const BodyPoint& point,
                          const Skeleton& skeleton) {
  if (!resolve_segment(skeleton, point.segment)) {
    const std::vector<std::string_view> names = segment_names(skeleton);
    return constraint_error(
        constraint,
        "the character has no segment " + in_quotes(point.segment),
        names.empty() ? "add joints to the skeleton" : suggestion(point.segment, names));
  }
  return check_place(constraint, "offset", point.offset_in_t_pose);
}

OptionalError check_goal(const Constraint& constraint,
                         const ConstraintSet& set,
                         const Character& character) {
  return std::visit(GoalCheck{constraint, set, character}, constraint.goal);
}

}  // namespace marey::retarget
