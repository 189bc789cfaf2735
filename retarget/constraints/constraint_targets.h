// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/constraint.h"
#include "core/transform.h"

namespace marey::retarget {

/// A point and its target position, the common form of all constraints (Kulpa 2005, 3.3).
struct PointTarget {
  glm::dvec3 p_in_world{0.0};       ///< Position of a point of the body (CP). [m]
  glm::dvec3 target_in_world{0.0};  ///< Target position (Cible). [m]
};

/// Positions that the goal of a constraint uses.
struct GoalPlaces {
  glm::dvec3 p_in_world{0.0};  ///< Constrained point.
  /// Its segment: position of the joint, and rotation from the T-pose.
  RigidTransform world_from_segment;
  /// The other point, of a DistanceToBody or DistanceToConstraint.
  glm::dvec3 other_in_world{0.0};
  /// For a Support without its own position and rotation: those of the reference posture
  /// when the support began.
  glm::dvec3 footprint_in_world{0.0};
  glm::dquat footprint_world_from_t_pose{1.0, 0.0, 0.0, 0.0};
};

/// One to three points with their targets.
class PointTargets {
 public:
  void add(const PointTarget& target) { targets_[count_++] = target; }
  /// Returns the points. Valid as long as this object.
  [[nodiscard]] std::span<const PointTarget> all() const& {
    return {targets_.data(), count_};
  }
  void all() const&& = delete;

 private:
  std::array<PointTarget, 3> targets_;
  std::size_t count_ = 0;
};

/// Distance of the points of an orientation from their joint, along the T-pose's x and y.
/// An error of 1 mm there is one of 0.01 rad. [m]
inline constexpr double kLever_m = 0.1;

/// Returns the points and targets of a goal, in the world: for most goals the constrained
/// point itself; for a SegmentOrientation the ends of two levers, which rotate with the
/// segment about its joint; for a Support the point and both levers. The formulas are
/// those of retarget/constraints/constraint_projections.h, one per type of goal.
///
/// Pure, allocates nothing. Precondition: a goal that check_constraints() accepts; finite
/// positions; unit rotations.
[[nodiscard]] PointTargets targets_of(const Goal& goal, const GoalPlaces& places);

}  // namespace marey::retarget
