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

/// "Bring this point there": what every constraint becomes (Kulpa 2005, 3.3).
struct PointTarget {
  glm::dvec3 p_in_world{0.0};       ///< Where a point of the body is (CP). [m]
  glm::dvec3 target_in_world{0.0};  ///< Where it should be (Cible). [m]
};

/// Where things are, as far as a constraint's goal asks.
struct Places {
  glm::dvec3 p_in_world{0.0};  ///< The constrained point.
  /// Its segment: the joint's place, and how it is turned from the T-pose.
  RigidTransform world_from_segment;
  /// The other point, of a DistanceToBody or DistanceToConstraint.
  glm::dvec3 other_in_world{0.0};
  /// Of a Support that does not say itself where and how the foot stands: as the
  /// reference posture had it when the support began.
  glm::dvec3 footprint_in_world{0.0};
  glm::dquat footprint_world_from_t_pose{1.0, 0.0, 0.0, 0.0};
};

/// One to three points and their targets.
class PointTargets {
 public:
  void add(const PointTarget& target) { targets_[count_++] = target; }
  /// Valid as long as this.
  [[nodiscard]] std::span<const PointTarget> all() const& {
    return {targets_.data(), count_};
  }
  void all() const&& = delete;

 private:
  std::array<PointTarget, 3> targets_;
  std::size_t count_ = 0;
};

/// How far from its joint the points of an orientation are, along the T-pose's x and y.
/// An error of 1 mm there is one of 0.01 rad. [m]
inline constexpr double kLever_m = 0.1;

/// The points that a goal wants moved, and where to, in the world: the constrained point
/// itself; of a SegmentOrientation the ends of two levers, which turn with the segment
/// about its joint; of a Support the point and both levers. The formulas are those of
/// retarget/conversions.h, one per type; another type is another function there.
///
/// Pure, allocates nothing. Precondition: what check_constraints() accepts, and finite
/// places; unit rotations.
[[nodiscard]] PointTargets targets_of(const Goal& goal, const Places& places);

}  // namespace marey::retarget
