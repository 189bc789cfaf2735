// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/reach_course.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

constexpr double kArrived_m = 0.003;
constexpr double kMinRate = 0.5;
constexpr double kSameTime_s = 1e-9;
constexpr double kLateTurn_rad = 0.02;

Motion3 way_between(const HandMotion& from, const HandMotion& to) {
  return {to.p_in_world - from.p_in_world,
          to.velocity_m_s - from.velocity_m_s,
          to.acceleration_m_s2 - from.acceleration_m_s2};
}

HandMotion hand_later(const HandMotion& hand, double after_s) {
  const RigidTransform frame = continued(hand, after_s);
  HandMotion later = hand;
  later.p_in_world = frame.translation;
  later.world_from_hand = frame.rotation;
  later.velocity_m_s += after_s * hand.acceleration_m_s2;
  later.turn_rad_s += after_s * hand.turn_acceleration_rad_s2;
  return later;
}

// The target as a hand; without a wanted rotation it turns as the clip's hand.
HandMotion target_as_hand(const ReachTarget& target,
                          const HandMotion& clip,
                          double after_s) {
  HandMotion hand = clip;
  hand.p_in_world = target.p_in_world + after_s * target.velocity_m_s;
  hand.velocity_m_s = target.velocity_m_s;
  hand.acceleration_m_s2 = glm::dvec3(0.0);
  if (target.world_from_hand) {
    hand.world_from_hand = rotation_from_vector(after_s * target.turn_rad_s) *
                           glm::normalize(*target.world_from_hand);
    hand.turn_rad_s = target.turn_rad_s;
    hand.turn_acceleration_rad_s2 = glm::dvec3(0.0);
  }
  return hand;
}

void move_on(ReachTarget& target, double after_s) {
  target.p_in_world += after_s * target.velocity_m_s;
  if (target.world_from_hand) {
    target.world_from_hand =
        rotation_from_vector(after_s * target.turn_rad_s) * *target.world_from_hand;
  }
}

// Moves a target onto the ball. Returns the distance.
double bring_within(const ReachBall& ball, ReachTarget& target) {
  const glm::dvec3 from_centre = target.p_in_world - ball.centre_in_world;
  const double distance_m = glm::length(from_centre);
  if (distance_m <= ball.radius_m) return 0.0;
  const glm::dvec3 direction = from_centre / distance_m;
  target.p_in_world = ball.centre_in_world + ball.radius_m * direction;
  const glm::dvec3 velocity = target.velocity_m_s;
  target.velocity_m_s = (ball.radius_m / distance_m) *
                        (velocity - glm::dot(velocity, direction) * direction);
  return distance_m - ball.radius_m;
}

Motion3 leg_until_end(const QuinticLeg& leg, double time_s) {
  return time_s < leg.end_s() ? leg.at(time_s) : Motion3{};
}

}  // namespace

void ReachCourse::start(double time_s,
                        const HandMotion& clip_now,
                        const ReachOptions& options,
                        const std::optional<HandMotion>& shown) {
  *this = ReachCourse{};
  options_ = options;
  phase_ = ReachPhase::kReaching;
  time_s_ = time_s;
  if (!shown) return;
  moved_m_ = way_between(clip_now, *shown);
  turned_rad_ = turn_between(clip_now, *shown, glm::dvec3(0.0));
}

void ReachCourse::release() {
  released_ = true;
}

ReachOutput ReachCourse::step(const ReachInput& input) {
  MAREY_ASSERT(input.step_s > 0.0 && input.time_s >= time_s_ - kSameTime_s);
  ReachOutput output;
  output.hand = input.clip_now;
  output.arrive_s = input.arrive_s;
  follow_target(input, output);
  if (released_ && phase_ == ReachPhase::kReaching) {
    begin_return(time_s_, moved_m_, turned_rad_);
  }
  if (phase_ == ReachPhase::kReaching) {
    reach(input, output);
  } else if (phase_ == ReachPhase::kHolding) {
    absorb_jump(input, held_base(input));
    hold(input, output);
  }
  if (phase_ == ReachPhase::kReturning) come_back(input, output);
  last_target_ = target_;
  time_s_ = input.time_s;
  output.phase = phase_;
  output.has_arrived = has_arrived_;
  output.rate = 1.0;
  if (input.clip_remaining_s > 0.0 && output.arrive_s > input.time_s) {
    output.rate =
        std::max(kMinRate, input.clip_remaining_s / (output.arrive_s - input.time_s));
  }
  return output;
}

void ReachCourse::follow_target(const ReachInput& input, ReachOutput& output) {
  const double since_s = input.time_s - time_s_;
  if (input.target && is_usable(*input.target)) {
    given_ = *input.target;
  } else {
    output.target_lost = true;
    if (given_) {
      move_on(*given_, since_s);
      const double decay = std::exp(-since_s / options_.trust_s);
      given_->velocity_m_s *= decay;
      given_->turn_rad_s *= decay;
    }
  }
  if (given_) {
    target_ = *given_;
    if (input.within) output.missing_m = bring_within(*input.within, target_);
    return;
  }
}

void ReachCourse::advance_to(double time_s) {
  moved_m_ = plan_.move_m.at(time_s);
  turned_rad_ = plan_.turn_rad.at(time_s);
}

// Before a target has been seen the hand stays with the clip, or goes there.
void ReachCourse::wait(const ReachInput& input, ReachOutput& output) {
  if (input.arrive_s <= input.time_s) {
    begin_return(time_s_, moved_m_, turned_rad_);
    return;
  }
  plan_.move_m =
      fade_leg(time_s_, options_.return_s, moved_m_, options_.max_acceleration_m_s2);
  plan_.turn_rad = fade_leg(
      time_s_, options_.return_s, turned_rad_, options_.max_turn_acceleration_rad_s2);
  advance_to(input.time_s);
  output.hand = displaced(input.clip_now, moved_m_, turned_rad_);
  output.turns = glm::length(turned_rad_.value) > 0.0;
  output.remaining_s = input.arrive_s - input.time_s;
}

void ReachCourse::reach(const ReachInput& input, ReachOutput& output) {
  if (!given_) {
    wait(input, output);
    return;
  }
  const double latest_s =
      std::max(input.arrive_s, input.time_s + input.clip_remaining_s / kMinRate);
  const bool is_last =
      has_plan_ && plan_.arrive_s() - time_s_ <= 2.0 * input.step_s * (1.0 + 1e-6);
  if (!is_last && input.arrive_s > time_s_ + kSameTime_s) {
    plan_ = plan_arrival({.start_s = time_s_,
                          .moved_m = moved_m_,
                          .turned_rad = turned_rad_,
                          .clip_at_arrival = input.clip_at_arrival,
                          .arrive_s = input.arrive_s,
                          .latest_s = latest_s,
                          .target = target_,
                          .target_time_s = input.time_s},
                         options_);
    has_plan_ = true;
  }
  // The event may come before the end of a plan that was put off, if the caller did not
  // slow the clip.
  double end_s = time_s_;
  if (has_plan_) {
    const double event_s = std::max(input.arrive_s, time_s_);
    end_s = is_last || event_s > input.time_s ? plan_.arrive_s()
                                              : std::min(plan_.arrive_s(), event_s);
    advance_to(std::min(end_s, input.time_s));
  }
  if (end_s > input.time_s) {
    output.arrive_s = std::min(std::max(plan_.arrive_s(), input.arrive_s), latest_s);
    output.remaining_s = plan_.arrive_s() - input.time_s;
    output.hand = displaced(input.clip_now, moved_m_, turned_rad_);
    output.turns = glm::length(turned_rad_.value) > 0.0 || target_.world_from_hand;
    return;
  }
  arrive(input, end_s);
  if (phase_ == ReachPhase::kHolding) hold(input, output);
}

void ReachCourse::arrive(const ReachInput& input, double event_s) {
  const HandMotion clip = hand_later(input.clip_at_arrival, event_s - input.arrive_s);
  const HandMotion base = target_as_hand(target_, clip, event_s - input.time_s);
  const HandMotion hand = displaced(clip, moved_m_, turned_rad_);
  const Motion3 from_target = way_between(base, hand);
  has_arrived_ = glm::length(from_target.value) <= kArrived_m;
  if (has_arrived_ && options_.after == AfterArrival::kReturn) {
    begin_return(event_s, moved_m_, turned_rad_);
    return;
  }
  phase_ = ReachPhase::kHolding;
  time_s_ = event_s;
  moved_m_ = from_target;
  turned_rad_ = turn_between(base, hand, glm::dvec3(0.0));
  plan_.move_m =
      fade_leg(event_s, options_.settle_s, moved_m_, options_.max_acceleration_m_s2);
  plan_.turn_rad = fade_leg(
      event_s, options_.settle_s, turned_rad_, options_.max_turn_acceleration_rad_s2);
}

HandMotion ReachCourse::held_base(const ReachInput& input) const {
  return target_as_hand(target_, input.clip_now, 0.0);
}

// A target that accelerates by more than the limit, or jumps, is left: the hand follows
// it from where the old movement would be.
void ReachCourse::absorb_jump(const ReachInput& input, const HandMotion& base) {
  const double since_s = input.time_s - time_s_;
  const double limit = options_.max_acceleration_m_s2 * since_s;
  const HandMotion expected = target_as_hand(last_target_, input.clip_now, since_s);
  const glm::dvec3 faster = base.velocity_m_s - expected.velocity_m_s;
  const glm::dvec3 further =
      base.p_in_world - expected.p_in_world - 0.5 * since_s * faster;
  if (glm::length(faster) > limit || glm::length(further) > 0.5 * since_s * limit) {
    Motion3 moved = leg_until_end(plan_.move_m, input.time_s);
    moved.value += expected.p_in_world - base.p_in_world;
    moved.rate -= faster;
    plan_.move_m =
        fade_leg(input.time_s, options_.settle_s, moved, options_.max_acceleration_m_s2);
  }
  const double turn_limit = options_.max_turn_acceleration_rad_s2 * since_s;
  const glm::dvec3 turns_faster = base.turn_rad_s - expected.turn_rad_s;
  const glm::dvec3 turns_further =
      rotation_vector(base.world_from_hand * glm::conjugate(expected.world_from_hand)) -
      0.5 * since_s * turns_faster;
  if (target_.world_from_hand.has_value() != last_target_.world_from_hand.has_value() ||
      glm::length(turns_faster) > turn_limit ||
      glm::length(turns_further) > 0.5 * since_s * turn_limit) {
    const Motion3 turned = leg_until_end(plan_.turn_rad, input.time_s);
    const HandMotion hand = displaced(expected, Motion3{}, turned);
    plan_.turn_rad = fade_leg(input.time_s,
                              options_.settle_s,
                              turn_between(base, hand, turned.value),
                              options_.max_turn_acceleration_rad_s2);
  }
}

void ReachCourse::hold(const ReachInput& input, ReachOutput& output) {
  moved_m_ = leg_until_end(plan_.move_m, input.time_s);
  turned_rad_ = leg_until_end(plan_.turn_rad, input.time_s);
  output.hand = displaced(held_base(input), moved_m_, turned_rad_);
  output.turns =
      target_.world_from_hand.has_value() || glm::length(turned_rad_.value) > 0.0;
  has_arrived_ = has_arrived_ || (glm::length(moved_m_.value) <= kArrived_m &&
                                  glm::length(turned_rad_.value) <= kLateTurn_rad);
  if (!has_arrived_) {
    output.remaining_s = std::max(0.0, plan_.move_m.end_s() - input.time_s);
  }
  if (released_ || (has_arrived_ && options_.after == AfterArrival::kReturn)) {
    begin_return(input.time_s,
                 way_between(input.clip_now, output.hand),
                 turn_between(input.clip_now, output.hand, glm::dvec3(0.0)));
  }
}

void ReachCourse::begin_return(double time_s,
                               const Motion3& moved_m,
                               const Motion3& turned_rad) {
  phase_ = ReachPhase::kReturning;
  plan_.move_m =
      fade_leg(time_s, options_.return_s, moved_m, options_.max_acceleration_m_s2);
  plan_.turn_rad = fade_leg(
      time_s, options_.return_s, turned_rad, options_.max_turn_acceleration_rad_s2);
}

void ReachCourse::come_back(const ReachInput& input, ReachOutput& output) {
  moved_m_ = leg_until_end(plan_.move_m, input.time_s);
  turned_rad_ = leg_until_end(plan_.turn_rad, input.time_s);
  output.hand = displaced(input.clip_now, moved_m_, turned_rad_);
  output.turns = glm::length(turned_rad_.value) > 0.0;
  output.remaining_s = 0.0;
  if (input.time_s >= std::max(plan_.move_m.end_s(), plan_.turn_rad.end_s())) {
    phase_ = ReachPhase::kDone;
  }
}

}  // namespace marey::engine
