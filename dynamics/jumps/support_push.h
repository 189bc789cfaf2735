// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <variant>

#include "dynamics/jumps/jump.h"
#include "dynamics/jumps/jump_wish.h"
#include "dynamics/push/force_push.h"
#include "dynamics/push/thesis_push.h"
#include <glm/vec3.hpp>

namespace marey::dynamics {

/// Captured force of a support along the world's axes, from which others are derived.
struct SupportReference {
  ComState start;
  ComState end;
  double gravity_m_s2 = kStandardGravity_m_s2;  ///< Gravity of the captured motion.
  std::array<PushReference, 3> axes;            ///< X, Y (with gravity), Z.
  double peak_g = 0.0;  ///< Largest vertical force, in captured gravity.

  [[nodiscard]] double duration_s() const { return end.time_s - start.time_s; }
};

/// Requirements of a support: states at its ends and the way between.
struct SupportWish {
  ComState start;
  ComState end;
  double gravity_m_s2 = kStandardGravity_m_s2;
  double max_force_m_s2 = 0.0;
  std::optional<double> deepest_m{};
  /// Height above which legs are too short; left out where no push obeys it.
  std::optional<double> highest_m{};
  double friction = 0.8;
  PushLawKind law = PushLawKind::kForce;
  LowestPoint lowest;  ///< For the thesis law.
};

/// Path of the centre of mass over one support. The reference must outlive it.
class SupportPush {
 public:
  /// Times since the start of the support, within its duration.
  [[nodiscard]] glm::dvec3 p_in_world(double t_s) const;
  [[nodiscard]] glm::dvec3 velocity_m_s(double t_s) const;
  /// Returns the force per kilogram: acceleration plus gravity.
  [[nodiscard]] glm::dvec3 force_m_s2(double t_s) const;
  [[nodiscard]] double duration_s() const { return duration_s_; }
  /// False: horizontal forces exceed the friction at some instant, since no others meet
  /// the ends.
  [[nodiscard]] bool within_friction() const { return within_friction_; }
  /// Lowest point: share of the duration, to 1e-6, and height.
  [[nodiscard]] LowestPoint lowest() const { return lowest_; }
  /// Highest point, ends included. [m]
  [[nodiscard]] double highest_m() const { return highest_m_; }
  /// Largest vertical force at 65 instants. [m/s^2]
  [[nodiscard]] double peak_force_m_s2() const { return peak_force_m_s2_; }

 private:
  friend std::optional<SupportPush> derive_support(const SupportReference& reference,
                                                   const SupportWish& wish);
  void measure();
  [[nodiscard]] double height_m(double t_s) const;
  [[nodiscard]] double vertical_force_m_s2(double t_s) const;

  double duration_s_ = 0.0;
  std::variant<ForcePush, ThesisPush> vertical_;
  std::array<ForcePush, 2> across_;  ///< X, Z.
  bool within_friction_ = true;
  LowestPoint lowest_;
  double peak_force_m_s2_ = 0.0;
  double highest_m_ = 0.0;
};

/// Returns the ends of the thesis law for a wish: accelerations are the captured force's,
/// at least free fall. An upward velocity below 0.1 m/s at the start counts as 0, since
/// the law needs a body that stands or falls.
[[nodiscard]] PushEnds thesis_ends(const SupportReference& reference,
                                   const SupportWish& wish);

/// Derives the support that meets the wish. The vertical axis is solved first; horizontal
/// forces then are within the friction cone (each axis within 0.707 of it, or within what
/// the captured motion had). With the thesis law the
/// strength bounds the peak; `deepest_m` and `highest_m` are not used. nullopt: the
/// vertical push, or that of a horizontal axis, does not exist. Some ten
/// microseconds with the force law; allocates nothing with it.
[[nodiscard]] std::optional<SupportPush> derive_support(const SupportReference& reference,
                                                        const SupportWish& wish);

}  // namespace marey::dynamics
