// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/character.h"
#include "core/constraint.h"
#include "core/ids.h"
#include "core/transform.h"

namespace marey::retarget {

/// A point of a body, found: which joint carries it, and where.
struct CarriedPoint {
  JointIndex joint{};
  glm::dvec3 p_in_joint{0.0};                        ///< [m]
  glm::dquat t_pose_from_joint{1.0, 0.0, 0.0, 0.0};  ///< Of that joint.

  [[nodiscard]] glm::dvec3 in_world(std::span<const RigidTransform> joints) const {
    return joints[index(joint)] * p_in_joint;
  }
};

/// Precondition: the character has the segment (check_constraints()).
[[nodiscard]] CarriedPoint carried_point(const Character& character,
                                         const BodyPoint& point);

/// How far a posture is from what a constraint wants of it: orientations by an angle, all
/// others by a length. The other one is 0.
struct Shortfall {
  double m = 0.0;
  double rad = 0.0;
};

/// Supports are exact (Kulpa 2005, 4.2.4): as near as this, whatever their precision. [m]
inline constexpr double kSupportPrecision_m = 1e-4;

/// An error is as good as none below this: what single precision leaves of a body that
/// is some metres from the world's origin, and six decimals of a file. [m]
inline constexpr double kMeasured_m = 2e-5;

/// Whether that little is within the constraint's precision, and kMeasured_m. Of an
/// orientation the precision is that of a point at kLever_m from its joint
/// (retarget/constraint_targets.h): 1 mm is 0.01 rad.
[[nodiscard]] bool is_met(const Constraint& constraint, const Shortfall& lacks);

/// How far postures of one character are from what one constraint wants, by the formulas
/// of targets_of() alone, whoever made them: a judge that knows nothing of the solve.
class ConstraintMeasure {
 public:
  /// Precondition: check_constraints() accepts `set`, which `constraint` is of.
  ConstraintMeasure(const Character& character,
                    const Constraint& constraint,
                    const ConstraintSet& set);

  [[nodiscard]] const CarriedPoint& point() const { return point_; }
  /// Supports without a footprint: from `footprint_in_world`; only their point counts,
  /// not how the foot is turned.
  [[nodiscard]] Shortfall lacks(std::span<const RigidTransform> world_from_joint,
                                const glm::dvec3& footprint_in_world) const;

 private:
  Goal goal_;
  CarriedPoint point_;
  std::optional<CarriedPoint> other_;
};

}  // namespace marey::retarget
