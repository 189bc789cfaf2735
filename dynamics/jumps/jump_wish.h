// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "dynamics/push/push_ends.h"
#include <glm/vec3.hpp>

namespace marey::dynamics {

/// Wanted properties of a jump, any that do not contradict each other. The others keep
/// the captured jump's values: rise, durations, horizontal velocity.
struct JumpWish {
  /// Highest point of the centre of mass: above the floor of the take-off, or added to
  /// the captured one. At most one of both. [m]
  std::optional<double> apex_m{};
  std::optional<double> apex_by_m{};
  std::optional<double> airtime_s{};
  /// Horizontal distance between the middles of the soles at take-off and landing. The
  /// direction is the captured one; that of the flight, or +Z, for a jump in place.
  std::optional<double> length_m{};
  /// Middle of the soles at landing, on the floor. Excludes length_m and box_m.
  std::optional<glm::dvec3> landing_in_world{};
  /// Height of the floor of the landing above that of the take-off.
  std::optional<double> box_m{};
  std::optional<double> push_s{};  ///< Duration of the push.

  [[nodiscard]] bool is_empty() const {
    return !apex_m && !apex_by_m && !airtime_s && !length_m && !landing_in_world &&
           !box_m && !push_s;
  }
};

enum class PushLawKind {
  kForce,   ///< The captured push and the smallest correction that is never negative.
  kThesis,  ///< A polynomial of degree 7 (Kulpa 2005, 6.3).
};

/// A lowest point of the push for the thesis law: share of the push's duration, and
/// height.
struct LowestPoint {
  double at = 0.5;
  double height_m = 0.0;
};

/// Abilities of the body.
struct JumpTraits {
  /// Largest vertical push in g. nullopt: 1.3 times the captured one's peak, at
  /// least 2.5.
  std::optional<double> strength_g{};
  /// Lowest height of the centre of mass. nullopt: 0.4 of that at take-off above the
  /// floor, or the captured one if that is lower.
  std::optional<double> deepest_m{};
  double friction = 0.8;  ///< Horizontal force per vertical force, at most.
};

/// A capture whose gravity is within this factor of the right one falls at a wrong rate,
/// and keeps its times. Beyond it, the motion was scaled from another body.
inline constexpr double kCaptureGravityFactor = 1.34;

/// Choices of a plan that are not wishes.
struct PlanJumpOptions {
  double gravity_m_s2 = kStandardGravity_m_s2;  ///< 0.5 to 30.
  PushLawKind law = PushLawKind::kForce;
  /// Lowest point of the thesis law; nullopt: the captured one.
  std::optional<LowestPoint> lowest{};
  /// The flight becomes a parabola although nothing is wished.
  bool ballistic = false;
  /// The duration of the whole jump changes by a multiple of this, so that the frames
  /// after it stay frames. 0: by any amount.
  double grid_s = 0.0;
};

}  // namespace marey::dynamics
