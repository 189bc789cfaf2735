// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/reach_plan.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

// A plan that is made again from its own middle differs by rounding and by the target's
// last movement; that alone must not put off the arrival.
constexpr double kLimitSlack = 1.03;
constexpr int kMaxRefinements = 40;

// Factor by which a leg has to be longer; at most 1: it is long enough. Ends that
// accelerate more than the limit are no reason, as no length changes them.
double stretch(const QuinticLeg& leg,
               const Motion3& from,
               const Motion3& to,
               double max_acceleration) {
  const double allowed = kLimitSlack * std::max({max_acceleration,
                                                 glm::length(from.acceleration),
                                                 glm::length(to.acceleration)});
  const double factor = std::sqrt(leg.max_acceleration() / allowed);
  return factor <= 1.0 ? 1.0 : std::clamp(factor, 1.01, 1.6);
}

// Wanted hand at a time of arrival.
HandMotion wanted_hand(const ArrivalQuestion& question,
                       const ReachOptions& options,
                       const HandMotion& clip,
                       double arrive_s) {
  const ReachTarget& target = question.target;
  const double ahead_s = std::max(0.0, arrive_s - question.target_time_s);
  // Falls to e^-1 at trust_s. Its square makes the prediction exact towards the arrival,
  // so the last plans hardly change: with e^(-T / trust_s) a target at 0.5 m/s moves the
  // predicted place by 1.4 mm between the last two plans.
  const double trusts = ahead_s / options.trust_s;
  const double trust = std::exp(-trusts * trusts);
  HandMotion wanted = clip;
  wanted.p_in_world = target.p_in_world + ahead_s * trust * target.velocity_m_s;
  wanted.velocity_m_s = target.velocity_m_s;
  wanted.acceleration_m_s2 = glm::dvec3(0.0);
  const double speed_m_s =
      target.speed_m_s.value_or(target.approach ? options.approach_speed_m_s : 0.0);
  const glm::dvec3 direction = target.approach.value_or(clip.velocity_m_s);
  const double length = glm::length(direction);
  if (length > 1e-9) wanted.velocity_m_s += (speed_m_s / length) * direction;
  if (target.world_from_hand) {
    wanted.turn_rad_s = target.turn_rad_s;
    wanted.turn_acceleration_rad_s2 = glm::dvec3(0.0);
    wanted.world_from_hand = rotation_from_vector(ahead_s * trust * target.turn_rad_s) *
                             glm::normalize(*target.world_from_hand);
  }
  return wanted;
}

Motion3 difference(const HandMotion& from, const HandMotion& to) {
  return {to.p_in_world - from.p_in_world,
          to.velocity_m_s - from.velocity_m_s,
          to.acceleration_m_s2 - from.acceleration_m_s2};
}

HandMotion slowed(HandMotion hand, double rate) {
  hand.velocity_m_s *= rate;
  hand.turn_rad_s *= rate;
  hand.acceleration_m_s2 *= rate * rate;
  hand.turn_acceleration_rad_s2 *= rate * rate;
  return hand;
}

}  // namespace

ArrivalPlan plan_arrival(const ArrivalQuestion& question, const ReachOptions& options) {
  MAREY_ASSERT(question.arrive_s > question.start_s);
  const double first_s = question.arrive_s - question.start_s;
  const double latest_s = std::max(first_s, question.latest_s - question.start_s);
  double length_s = first_s;
  ArrivalPlan plan;
  for (int i = 0; i < kMaxRefinements; ++i) {
    const HandMotion clip =
        slowed(question.clip_at_arrival, first_s / std::min(length_s, latest_s));
    const HandMotion wanted =
        wanted_hand(question, options, clip, question.start_s + length_s);
    const Motion3 to = difference(clip, wanted);
    plan.move_m = quintic_leg(question.start_s, length_s, question.moved_m, to);
    Motion3 turn_to;
    if (question.target.world_from_hand) {
      turn_to = turn_between(clip, wanted, question.turned_rad.value);
    }
    plan.turn_rad = quintic_leg(question.start_s, length_s, question.turned_rad, turn_to);
    const double factor = std::max(
        stretch(plan.move_m, question.moved_m, to, options.max_acceleration_m_s2),
        stretch(plan.turn_rad,
                question.turned_rad,
                turn_to,
                options.max_turn_acceleration_rad_s2));
    if (factor <= 1.0) break;
    length_s *= factor;
  }
  return plan;
}

QuinticLeg fade_leg(double start_s,
                    double min_length_s,
                    const Motion3& from,
                    double max_acceleration) {
  MAREY_ASSERT(min_length_s > 0.0);
  double length_s = min_length_s;
  QuinticLeg leg;
  for (int i = 0; i < kMaxRefinements; ++i) {
    leg = quintic_leg(start_s, length_s, from, Motion3{});
    const double factor = stretch(leg, from, Motion3{}, max_acceleration);
    if (factor <= 1.0) break;
    length_s *= factor;
  }
  return leg;
}

}  // namespace marey::engine
