// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "dynamics/jumps/jump_plan.h"
#include "dynamics/jumps/jump_wish.h"
#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/time_warp.h"

namespace marey::dynamics {

/// Steps of plan_jump().
class JumpPlanner {
 public:
  JumpPlanner(const JumpReference& reference,
              const JumpWish& wish,
              const JumpTraits& traits,
              const PlanJumpOptions& options);

  [[nodiscard]] Result<JumpPlan> plan();

 private:
  /// Sets the height, the place and the time of take-off and touch-down.
  [[nodiscard]] Status solve_flight();
  [[nodiscard]] Result<double> takeoff_speed() const;
  /// Moves the landing so that the horizontal velocity of the flight is the captured one.
  void keep_level_speed(double flight_s);
  void add_friction_finding(const char* phase);
  [[nodiscard]] Status solve_push();
  [[nodiscard]] Status solve_landing();
  /// Lowest height of the centre of mass that legs permit above a floor.
  [[nodiscard]] double deepest_m(const SupportPush& captured, double floor_m) const;
  [[nodiscard]] SupportWish push_wish(double speed_m_s) const;
  [[nodiscard]] SupportWish landing_wish(double duration_s) const;
  /// Returns the error of a push that does not exist, with the possible apexes.
  [[nodiscard]] Error push_refused() const;
  /// Returns the largest difference to the captured jump, in metres or equivalents.
  [[nodiscard]] double change_m() const;
  [[nodiscard]] std::vector<WarpKnot> warp_knots() const;
  /// Height of a point of the centre of mass above the floor of the take-off.
  [[nodiscard]] double above_floor_m(double height_m) const;

  const JumpReference& reference_;
  const Jump& jump_;
  const JumpWish& wish_;
  const JumpTraits& traits_;
  const PlanJumpOptions& options_;
  double gravity_m_s2_;
  double strength_m_s2_;
  double time_scale_;  ///< Factor of captured durations without a wish.
  double push_s_;
  ComState takeoff_;
  std::optional<ComState> touchdown_{};
  std::optional<ComState> rest_{};
  glm::dvec3 moved_m_{0.0};
  double delay_s_ = 0.0;
  std::optional<SupportPush> push_{};
  std::optional<SupportPush> landing_{};
  std::vector<Finding> findings_;
};

}  // namespace marey::dynamics
