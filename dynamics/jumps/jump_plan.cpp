// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/jumps/jump_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/smooth_step.h"

namespace marey::dynamics {
namespace {

/// Share of a support in which the residual fades next to the flight.
constexpr double kResidualFade = 0.14;

}  // namespace

JumpPlan::JumpPlan(const JumpReference& reference, std::vector<WarpKnot> knots)
    : reference_(&reference), warp_(knots, 1.0) {}

double JumpPlan::lowest_s() const {
  return start_.time_s + push_.lowest().at * push_.duration_s();
}

double JumpPlan::apex_s() const {
  return takeoff_.time_s + std::max(0.0, takeoff_.velocity_m_s.y) / gravity_m_s2_;
}

double JumpPlan::apex_m() const {
  const double up_m_s = std::max(0.0, takeoff_.velocity_m_s.y);
  return takeoff_.p_in_world.y + 0.5 * up_m_s * up_m_s / gravity_m_s2_;
}

double JumpPlan::residual_share(double time_s) const {
  double from_flight = 0.0;
  if (time_s < takeoff_.time_s) {
    from_flight = (takeoff_.time_s - time_s) / push_.duration_s();
  } else if (landing_ && time_s > touchdown_->time_s) {
    from_flight = (time_s - touchdown_->time_s) / landing_->duration_s();
  }
  return flight_residual_share_ +
         (1.0 - flight_residual_share_) * smooth_step(from_flight / kResidualFade);
}

glm::dvec3 JumpPlan::com_in_world(double time_s) const {
  const Jump& captured = reference_->jump();
  if (is_identity_ || time_s <= start_.time_s) return reference_->captured(time_s);
  const double share = residual_share(time_s);
  if (time_s < takeoff_.time_s) {
    const double t_s = time_s - start_.time_s;
    const double source_s = captured.start.time_s +
                            t_s / push_.duration_s() * reference_->push().duration_s();
    return push_.p_in_world(t_s) + share * reference_->residual(source_s);
  }
  if (landing_ && time_s >= rest_->time_s) {
    return reference_->captured(time_s - delay_s_) + landing_moved_m_;
  }
  if (landing_ && time_s > touchdown_->time_s) {
    const double t_s = time_s - touchdown_->time_s;
    const double source_s =
        captured.touchdown->time_s +
        t_s / landing_->duration_s() * reference_->landing()->duration_s();
    return landing_->p_in_world(t_s) + share * reference_->residual(source_s);
  }
  const double t_s = time_s - takeoff_.time_s;
  double source_s = captured.takeoff.time_s + t_s;
  if (touchdown_) {
    source_s = captured.takeoff.time_s +
               t_s / (touchdown_->time_s - takeoff_.time_s) *
                   (captured.touchdown->time_s - captured.takeoff.time_s);
  }
  return takeoff_.p_in_world + t_s * takeoff_.velocity_m_s -
         glm::dvec3(0.0, 0.5 * gravity_m_s2_ * t_s * t_s, 0.0) +
         share * reference_->residual(source_s);
}

double JumpPlan::push_g(double time_s) const {
  if (is_identity_ || time_s <= start_.time_s) {
    return reference_->captured_push_g(time_s);
  }
  if (time_s < takeoff_.time_s) {
    return push_.force_m_s2(time_s - start_.time_s).y / gravity_m_s2_;
  }
  if (!landing_ || time_s <= touchdown_->time_s) return 0.0;
  if (time_s < rest_->time_s) {
    return landing_->force_m_s2(time_s - touchdown_->time_s).y / gravity_m_s2_;
  }
  return reference_->captured_push_g(time_s - delay_s_);
}

}  // namespace marey::dynamics
