// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/foot_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

namespace marey::app {
namespace {

constexpr double kMillimetres = 1000.0;

/// One point of a foot that stands from time to time.
class StandingPoint {
 public:
  /// Returns the displacement since it began to stand; nullopt: it does not. [mm]
  std::optional<double> step(bool stands, const glm::dvec3& p_on_floor) {
    if (stands && !stands_) since_on_floor_ = p_on_floor;
    stands_ = stands;
    if (!stands) return std::nullopt;
    const double x_m = p_on_floor.x - since_on_floor_.x;
    const double z_m = p_on_floor.z - since_on_floor_.z;
    return kMillimetres * std::hypot(x_m, z_m);
  }

 private:
  bool stands_ = false;
  glm::dvec3 since_on_floor_{0.0};
};

double yaw_of(const glm::dquat& world_from_t_pose) {
  const glm::dvec3 forward = world_from_t_pose * glm::dvec3(0.0, 0.0, 1.0);
  return std::atan2(forward.x, forward.z);
}

}  // namespace

WorstValue foot_slide_mm(std::span<const FootStep> steps) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  WorstValue worst;
  StandingPoint ankle;
  StandingPoint ball;
  for (const FootStep& step : steps) {
    const bool flat = step.stance == FootStance::kFlat;
    const bool on_heel = flat || step.stance == FootStance::kHeel;
    const bool on_ball = flat || step.stance == FootStance::kBall;
    const double moved_mm =
        std::min(ankle.step(on_heel, step.ankle_on_floor).value_or(kNone),
                 ball.step(on_ball, step.ball_on_floor).value_or(kNone));
    if (on_heel || on_ball) worst.add(moved_mm, step.time_s);
  }
  return worst;
}

WorstValue foot_twist_deg(std::span<const FootStep> steps) {
  WorstValue worst;
  bool stands = false;
  double since_rad = 0.0;
  for (const FootStep& step : steps) {
    if (step.stance == FootStance::kNone) {
      stands = false;
      continue;
    }
    const double yaw_rad = yaw_of(step.world_from_t_pose);
    if (!stands) since_rad = yaw_rad;
    stands = true;
    const double turn_rad = std::remainder(yaw_rad - since_rad, glm::two_pi<double>());
    worst.add(std::abs(glm::degrees(turn_rad)), step.time_s);
  }
  return worst;
}

FootStance stance_of(double ankle_raised_m, double ball_raised_m, double tolerance_m) {
  if (ankle_raised_m - ball_raised_m > tolerance_m) return FootStance::kBall;
  if (ball_raised_m - ankle_raised_m > tolerance_m) return FootStance::kHeel;
  return FootStance::kFlat;
}

}  // namespace marey::app
