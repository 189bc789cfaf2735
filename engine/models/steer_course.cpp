// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/steer_course.h"

#include <algorithm>
#include <cmath>

#include "engine/models/steer_forecast.h"
#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::engine {
namespace {

// A swing shorter than it is not turned. [s]
constexpr double kMinCurve_s = 0.05;

bool are_permitted(const SteerSettings& s) {
  return s.max_turn_rad > 0.0 && s.max_turn_rad <= 1.5 && s.max_turn_rad_s > 0.0 &&
         s.min_scale > 0.0 && s.min_scale <= 1.0 && s.max_scale >= 1.0 &&
         s.max_scale < 2.0 && s.keep_s >= 0.0 && s.max_duration_s > 0.0 &&
         s.stop_m >= 0.0 && std::isfinite(s.max_turn_rad_s) && std::isfinite(s.keep_s) &&
         std::isfinite(s.max_duration_s) && std::isfinite(s.stop_m);
}

void check(const SteerInput& now) {
  MAREY_ASSERT(now.step_s > 0.0 && now.rate > 0.0 && now.leg_length_m > 0.0);
  MAREY_ASSERT(std::isfinite(now.time_s + now.root.x_m + now.root.z_m +
                             now.root.heading_rad + now.clip_s));
}

bool stands_alone(const std::array<bool, 2>& bears) {
  return bears[0] != bears[1];
}

}  // namespace

Status SteerCourse::start(const MotionClip& clip,
                          const ClipTravel& travel,
                          const SteerSettings& settings) {
  if (!are_permitted(settings)) {
    return bad_input("steer " + clip.name,
                     "a limit of the course is out of range",
                     "use the ranges that SteerSettings states");
  }
  *this = {};
  clip_ = &clip;
  travel_ = &travel;
  settings_ = settings;
  return Done{};
}

Status SteerCourse::aim(glm::dvec2 goal_xz_m) {
  MAREY_ASSERT(clip_ != nullptr);
  if (!std::isfinite(goal_xz_m.x) || !std::isfinite(goal_xz_m.y)) {
    return bad_input("steer " + clip_->name,
                     "the goal is not a finite number",
                     "give the goal as x and z in metres");
  }
  if (has_goal_ && goal_xz_m == goal_xz_m_) return Done{};
  goal_xz_m_ = goal_xz_m;
  has_goal_ = true;
  is_goal_new_ = true;
  state_ = SteerState::kUnderWay;
  return Done{};
}

SteerStep SteerCourse::step(const SteerInput& now) {
  MAREY_ASSERT(clip_ != nullptr);
  check(now);
  note_landings(now);
  SteerStep out;
  if (swing_.is_active) move_along_swing(now, out);
  const bool is_new = is_goal_new_ && has_goal_;
  if (is_new) end_s_ = now.time_s + settings_.max_duration_s;
  if (has_goal_ && state_ == SteerState::kUnderWay) {
    if ((has_landed_ || (is_new && !swing_.is_active)) && has_arrived(now, is_new)) {
      state_ = SteerState::kArrived;
    } else if (now.time_s > end_s_ && !swing_.is_active) {
      state_ = SteerState::kOutOfTime;
    }
  }
  const bool is_led = has_goal_ && state_ == SteerState::kUnderWay;
  if (!swing_.is_active && stands_alone(now.bears)) {
    begin_swing(now);
    if (is_led) plan_swing(now, now.root);
  } else if (swing_.is_active && is_led && is_new) {
    swing_.is_last = false;
    const bool is_early =
        stands_alone(now.bears) &&
        swing_.alone_end_s - now.time_s >= std::max(settings_.keep_s, kMinCurve_s);
    if (is_early) plan_swing(now, steered(now.root, out));
  }
  is_goal_new_ = false;
  const RootPlace root = steered(now.root, out);
  out.scale = scale_;
  out.state = state_;
  out.arrived = state_ == SteerState::kArrived;
  out.steps_left = is_led ? std::max(steps_left_, 1) : 0;
  out.distance_m =
      has_goal_ ? glm::length(goal_xz_m_ - glm::dvec2{root.x_m, root.z_m}) : 0.0;
  out.twist_rad = {now.bears[0] ? twist_rad_[0] : 0.0,
                   now.bears[1] ? twist_rad_[1] : 0.0};
  return out;
}

void SteerCourse::note_landings(const SteerInput& now) {
  has_landed_ = false;
  for (std::size_t foot = 0; foot < 2; ++foot) {
    if (!now.bears[foot] || bore_[foot]) continue;
    has_landed_ = true;
    twist_rad_[foot] = 0.0;
  }
  bore_ = now.bears;
  if (!has_landed_ || !swing_.is_active) return;
  swing_.is_active = false;
  scale_ = 1.0;
  steps_left_ = std::max(steps_left_ - 1, 0);
}

void SteerCourse::begin_swing(const SteerInput& now) {
  swing_ = {};
  swing_.is_active = true;
  swing_.stands = now.bears[0] ? 0 : 1;
  keep_up_with_edges(now);
}

// The turn ends a step before the foot stops to stand alone, so that none of it is left.
void SteerCourse::keep_up_with_edges(const SteerInput& now) {
  const double lift_s = now.until_edge_s[swing_.stands];
  const double land_s = now.until_edge_s[1 - swing_.stands];
  const double alone_s = std::min(lift_s, land_s);
  swing_.alone_end_s = now.time_s + std::max(alone_s - now.step_s, 0.0);
  swing_.land_s = now.time_s + std::max(land_s - now.step_s, 0.0);
}

void SteerCourse::move_along_swing(const SteerInput& now, SteerStep& out) {
  if (stands_alone(now.bears)) {
    out.pivot_xz_m = now.foot_xz_m[swing_.stands];
    const double turned_rad = swing_.turn_rad.at(now.time_s).value;
    out.turn_rad = turned_rad - swing_.turned_rad;
    swing_.turned_rad = turned_rad;
    twist_rad_[swing_.stands] += out.turn_rad;
  } else if (swing_.turn_rad.target() != swing_.turned_rad) {
    // The foot has left the floor early: the rest of its turn is left to the next one.
    swing_.turn_rad.hold(swing_.turned_rad);
  }
  const glm::dvec2 shifted_m{swing_.shift_x_m.at(now.time_s).value,
                             swing_.shift_z_m.at(now.time_s).value};
  out.shift_xz_m = turned(shifted_m - swing_.shifted_m, swing_.turned_rad);
  swing_.shifted_m = shifted_m;
  // A foot that stands for less time than it was expected to: the curves end earlier.
  if (!stands_alone(now.bears)) return;
  const double end_s = swing_.alone_end_s;
  const double land_s = swing_.land_s;
  keep_up_with_edges(now);
  const auto shorten = [&](SwingCurve& curve, double end_s_now) {
    if (curve.end_s() > end_s_now + 1e-4 && end_s_now > now.time_s + 1e-4) {
      curve.bend(now.time_s, end_s_now, curve.target());
    }
  };
  if (swing_.alone_end_s < end_s) {
    shorten_turn(now);
  }
  if (swing_.land_s < land_s) {
    shorten(swing_.shift_x_m, swing_.land_s);
    shorten(swing_.shift_z_m, swing_.land_s);
  }
}

void SteerCourse::shorten_turn(const SteerInput& now) {
  const double left_s = swing_.alone_end_s - now.time_s;
  SwingCurve& curve = swing_.turn_rad;
  if (left_s < 1e-4 || curve.end_s() <= swing_.alone_end_s + 1e-4) return;
  const CurveRange range = permitted_targets(
      curve.at(now.time_s), left_s, settings_.max_turn_rad, settings_.max_turn_rad_s);
  if (range.low > range.high) return;
  const double target_rad = std::clamp(curve.target(), range.low, range.high);
  curve.bend(now.time_s, swing_.alone_end_s, target_rad);
}

SteerScene SteerCourse::scene_of(const SteerInput& now) const {
  SteerScene scene{
      clip_, travel_, &settings_, now.leg_length_m, now.rate, goal_xz_m_, now.step_s};
  if (settings_.stop_m > 0.0) {
    const glm::dvec2 way = goal_xz_m_ - glm::dvec2{now.root.x_m, now.root.z_m};
    const double length_m = glm::length(way);
    if (length_m > settings_.stop_m) {
      scene.goal_xz_m -= way * (settings_.stop_m / length_m);
    }
  }
  return scene;
}

void SteerCourse::plan_swing(const SteerInput& now, const RootPlace& root) {
  const double turn_s = swing_.alone_end_s - now.time_s;
  const double shift_s = swing_.land_s - now.time_s;
  if (turn_s < kMinCurve_s || shift_s < kMinCurve_s) return;
  const SteerScene scene = scene_of(now);
  const double land_clip_s = now.clip_s + now.until_edge_s[1 - swing_.stands] * now.rate;
  const NextLanding landing = nearest_landing(*travel_, land_clip_s);
  SteerMoment moment = moment_of(scene, root, now.clip_s, land_clip_s, landing.step);
  moment.pivot_xz_m = now.foot_xz_m[swing_.stands];
  moment.end_xz_m -= turned(swing_.shifted_m, swing_.turned_rad);
  // The leg may have been turned by earlier swings of the other foot.
  const double before_rad = twist_rad_[swing_.stands] - swing_.turned_rad;
  const CurvePoint from = swing_.turn_rad.at(now.time_s);
  CurveRange range =
      permitted_targets(from, turn_s, settings_.max_turn_rad, settings_.max_turn_rad_s);
  range.low = std::max(range.low, -settings_.max_turn_rad - before_rad);
  range.high = std::min(range.high, settings_.max_turn_rad - before_rad);
  if (range.low > range.high) return;
  moment.turn_rad = {range.low - swing_.turned_rad, range.high - swing_.turned_rad};
  SteerForecast predicted;
  const SteerStrategy strategy = best_strategy(scene, moment, predicted);
  SteerMove move = choose_move(scene, moment, strategy);
  if (predicted.arrives && predicted.steps == 1 && move.missing_m <= kNear_m) {
    move.is_last = true;
  }
  swing_.turn_rad.bend(now.time_s, swing_.alone_end_s, swing_.turned_rad + move.turn_rad);
  const glm::dvec2 shift_m = turned(move.shift_xz_m, -swing_.turned_rad);
  swing_.shift_x_m.bend(now.time_s, swing_.land_s, shift_m.x);
  swing_.shift_z_m.bend(now.time_s, swing_.land_s, shift_m.y);
  swing_.is_last = move.is_last;
  steps_left_ = predicted.arrives ? predicted.steps : 1 + move.further_steps;
  const double step_m = travel_->steps[landing.step].length_legs * scene.leg_length_m;
  const glm::dvec2 along = turned({0.0, 1.0}, moment.course_rad);
  scale_ = step_m > 0.0 ? 1.0 + glm::dot(move.shift_xz_m, along) / step_m : 1.0;
}

bool SteerCourse::has_arrived(const SteerInput& now, bool not_begun) const {
  const SteerScene scene = scene_of(now);
  const NextLanding landing = next_landing(*travel_, now.clip_s);
  const SteerMoment moment =
      moment_of(scene, now.root, now.clip_s, landing.clip_s, landing.step);
  const glm::dvec2 root_xz_m{now.root.x_m, now.root.z_m};
  if (swing_.is_last && glm::length(scene.goal_xz_m - root_xz_m) <= kNear_m + 0.02) {
    return true;
  }
  return is_arrival(scene, root_xz_m, moment, not_begun);
}

RootPlace turn_about(const RootPlace& root, glm::dvec2 pivot_xz_m, double turn_rad) {
  const glm::dvec2 arm{root.x_m - pivot_xz_m.x, root.z_m - pivot_xz_m.y};
  const glm::dvec2 place = pivot_xz_m + turned(arm, turn_rad);
  return {place.x, place.y, root.heading_rad + turn_rad};
}

RootPlace steered(const RootPlace& root, const SteerStep& step) {
  RootPlace out =
      step.turn_rad == 0.0 ? root : turn_about(root, step.pivot_xz_m, step.turn_rad);
  out.x_m += step.shift_xz_m.x;
  out.z_m += step.shift_xz_m.y;
  return out;
}

}  // namespace marey::engine
