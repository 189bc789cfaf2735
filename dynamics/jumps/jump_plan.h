// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "dynamics/jumps/jump.h"
#include "dynamics/jumps/jump_reference.h"
#include "dynamics/jumps/support_push.h"
#include "dynamics/push/push_ends.h"
#include <glm/vec3.hpp>

#include "core/finding.h"
#include "core/time_warp.h"

namespace marey::dynamics {

/// A new course of the centre of mass for a captured jump. The reference must outlive it.
class JumpPlan {
 public:
  /// True: nothing was wished, and nothing changes.
  [[nodiscard]] bool is_identity() const { return is_identity_; }
  // States of the new jump, as in Jump.
  [[nodiscard]] const ComState& takeoff() const { return takeoff_; }
  [[nodiscard]] const std::optional<ComState>& touchdown() const { return touchdown_; }
  [[nodiscard]] const std::optional<ComState>& rest() const { return rest_; }
  [[nodiscard]] double start_s() const { return start_.time_s; }
  [[nodiscard]] double lowest_s() const;
  [[nodiscard]] double apex_s() const;
  [[nodiscard]] double apex_m() const;
  [[nodiscard]] double gravity_m_s2() const { return gravity_m_s2_; }
  /// Displacement of the landing, and of everything after it. [m]
  [[nodiscard]] const glm::dvec3& landing_moved_m() const { return landing_moved_m_; }
  /// Time by which everything after the jump is later.
  [[nodiscard]] double delay_s() const { return delay_s_; }
  [[nodiscard]] const SupportPush& push() const { return push_; }
  [[nodiscard]] const std::optional<SupportPush>& landing() const { return landing_; }
  [[nodiscard]] const std::vector<Finding>& findings() const { return findings_; }

  /// Returns the instant of the captured motion whose posture is shown at an instant of
  /// the new one. Monotone, with continuous speed and acceleration.
  [[nodiscard]] double source_s(double time_s) const { return warp_.source_s(time_s); }
  /// Returns the position of the centre of mass at an instant of the new motion.
  [[nodiscard]] glm::dvec3 com_in_world(double time_s) const;
  /// Returns the vertical force per kilogram, in g of the plan: 0 in flight.
  [[nodiscard]] double push_g(double time_s) const;

 private:
  friend class JumpPlanner;
  JumpPlan(const JumpReference& reference, std::vector<WarpKnot> knots);
  [[nodiscard]] double residual_share(double time_s) const;

  const JumpReference* reference_;
  bool is_identity_ = false;
  ComState start_;
  ComState takeoff_;
  std::optional<ComState> touchdown_;
  std::optional<ComState> rest_;
  double gravity_m_s2_ = kStandardGravity_m_s2;
  glm::dvec3 landing_moved_m_{0.0};
  double delay_s_ = 0.0;
  double flight_residual_share_ = 1.0;
  SupportPush push_;
  std::optional<SupportPush> landing_;
  TimeWarp warp_;
  std::vector<Finding> findings_;
};

}  // namespace marey::dynamics
