// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/character.h"
#include "core/constraint.h"
#include "core/transform.h"

namespace marey::retarget {

/// A point of a body: the joint that carries it, and its position there.
struct CarriedPoint {
  JointIndex joint{};
  glm::dvec3 p_in_joint{0.0};                        ///< [m]
  glm::dquat t_pose_from_joint{1.0, 0.0, 0.0, 0.0};  ///< For that joint.

  [[nodiscard]] glm::dvec3 in_world(std::span<const RigidTransform> joints) const {
    return joints[index(joint)] * p_in_joint;
  }
};

/// Finds a point of the character. Precondition: the character has the segment
/// (check_constraints()).
[[nodiscard]] CarriedPoint carried_point(const Character& character,
                                         const BodyPoint& point);

/// Error of a posture for a constraint: an angle for orientations, a length for all
/// others. The other value is 0.
struct Shortfall {
  double m = 0.0;
  double rad = 0.0;
};

/// Supports are exact (Kulpa 2005, 4.2.4): this tolerance replaces their precision. [m]
inline constexpr double kSupportPrecision_m = 1e-4;

/// Errors below this count as zero: resolution of single precision for a body some metres
/// from the world's origin, and of six decimals in a file. [m]
inline constexpr double kMeasured_m = 2e-5;

/// Returns true if the error is at most the constraint's precision plus kMeasured_m. For
/// an orientation, the precision applies to a point at kLever_m from its joint
/// (retarget/constraints/constraint_targets.h): 1 mm is 0.01 rad.
[[nodiscard]] bool is_met(const Constraint& constraint, const Shortfall& shortfall);

/// Returns the largest error for which is_met() returns true: [rad] for an orientation,
/// [m] for all others.
[[nodiscard]] double max_met_error(const Constraint& constraint);

/// Measures errors of postures of one character for one constraint, by the formulas of
/// targets_of() alone, independent of the solver.
class ConstraintMeasure {
 public:
  /// Precondition: check_constraints() accepts `set`, which contains `constraint`.
  ConstraintMeasure(const Character& character,
                    const Constraint& constraint,
                    const ConstraintSet& set);

  [[nodiscard]] const CarriedPoint& point() const { return point_; }
  /// Returns the error of a posture. Supports without a footprint are measured from
  /// `footprint_in_world`; only their point counts, not the rotation of the foot.
  [[nodiscard]] Shortfall shortfall(std::span<const RigidTransform> world_from_joint,
                                    const glm::dvec3& footprint_in_world) const;

 private:
  Goal goal_;
  CarriedPoint point_;
  std::optional<CarriedPoint> other_;
};

}  // namespace marey::retarget
