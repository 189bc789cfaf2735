// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/result.h"

namespace marey::engine {

/// Target of a reach at an instant. Everything may change from step to step.
struct ReachTarget {
  glm::dvec3 p_in_world{0.0};  ///< For the point of the hand that reaches (the palm).
  glm::dvec3 velocity_m_s{0.0};
  /// Direction in which the hand moves when it arrives, relative to the target; not zero,
  /// any length. nullopt: that of the clip's hand, if `speed_m_s` asks for a speed.
  std::optional<glm::dvec3> approach{};
  /// Speed of the hand relative to the target when it arrives. nullopt: 0, or
  /// ReachOptions::approach_speed_m_s with an approach direction.
  std::optional<double> speed_m_s{};
  /// Rotation of the hand from the T-pose when it arrives. nullopt: that of the clip.
  std::optional<glm::dquat> world_from_hand{};
  glm::dvec3 turn_rad_s{0.0};  ///< Angular velocity of that rotation, in world axes.
};

/// Refuses a target that cannot be asked for. Errors (bad input, naming the value): a
/// number that is not finite, a zero approach direction or rotation, a negative speed.
[[nodiscard]] Status check_target(const ReachTarget& target);
/// Returns true if check_target() accepts the target. Does not allocate.
[[nodiscard]] bool is_usable(const ReachTarget& target);

/// The points that a hand can reach: a ball. ask_reach() computes its radius.
struct ReachBall {
  glm::dvec3 centre_in_world{0.0};
  double radius_m = 0.0;
};

enum class AfterArrival {
  kHold,    ///< The hand moves with the target, until ReachCourse::release().
  kReturn,  ///< The displacement fades out; the clip's own hand returns.
};

struct ReachOptions {
  AfterArrival after = AfterArrival::kHold;
  /// Arrival is put off until the displacement can do with this. [m/s^2]
  double max_acceleration_m_s2 = 25.0;
  double max_turn_acceleration_rad_s2 = 150.0;
  double approach_speed_m_s = 0.1;  ///< See ReachTarget::speed_m_s.
  double trust_s = 0.3;             ///< Times e^-(T / this)^2 a target's velocity counts.
  double settle_s = 0.2;  ///< Minimum time in which the hand stops at the target.
  double return_s = 0.4;  ///< Minimum time in which the displacement fades out.
};

}  // namespace marey::engine
