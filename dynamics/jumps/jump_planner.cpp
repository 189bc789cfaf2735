// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/jumps/jump_planner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>

#include "dynamics/jumps/check_jump_wish.h"
#include "dynamics/jumps/landing_moved.h"
#include "dynamics/jumps/possible_speeds.h"
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/format_text.h"

namespace marey::dynamics {
namespace {

/// Changes below this are rounding. [m]
constexpr double kNoChange_m = 1e-9;
/// The residual of the flight is gone at this change, at least.
constexpr double kResidualGone_m = 0.03;
constexpr double kResidualGoneFactor = 4.0;
/// Contradicting wishes may differ by this.
constexpr double kSameTime_s = 1e-3;
/// A lowest point at another share than this was not the wanted one.
constexpr double kOtherLowest = 0.005;
/// Largest speed of the range of a refused push, over the captured one.
constexpr double kMostSpeed = 2.5;
/// Height of the centre of mass in the deepest squat, over that at take-off.
constexpr double kSquat = 0.4;
/// A support may be this much higher than the captured one.
constexpr double kOverCaptured_m = 0.002;
/// Durations of a landing that are tried, as factors.
constexpr std::array kLandingFactors{1.0, 1.1, 1.2, 1.35, 1.5, 1.75, 2.0};
/// Knots closer to others than this are left out. [s]
constexpr double kKnotGap_s = 0.02;

/// Returns the factor of durations between gravities. A capture that falls at nearly the
/// right rate keeps its times; a motion that was scaled to another body is played at the
/// rate at which that body falls.
double time_scale(double captured_m_s2, double wanted_m_s2) {
  const double ratio = captured_m_s2 / wanted_m_s2;
  return ratio < kCaptureGravityFactor && ratio > 1.0 / kCaptureGravityFactor
             ? 1.0
             : std::sqrt(ratio);
}

/// True if nothing is asked for: then the captured fall is kept, too.
bool is_unchanged(const JumpWish& wish, const PlanJumpOptions& options) {
  JumpWish rest = wish;
  if (rest.apex_by_m == 0.0) rest.apex_by_m.reset();
  return rest.is_empty() && !options.ballistic && options.law == PushLawKind::kForce &&
         options.gravity_m_s2 == kStandardGravity_m_s2;
}

std::string metres(double value_m) {
  return format_text("%.3f m", value_m);
}
std::string seconds(double value_s) {
  return format_text("%.3f s", value_s);
}

}  // namespace

JumpPlanner::JumpPlanner(const JumpReference& reference,
                         const JumpWish& wish,
                         const JumpTraits& traits,
                         const PlanJumpOptions& options)
    : reference_(reference),
      jump_(reference.jump()),
      wish_(wish),
      traits_(traits),
      options_(options),
      gravity_m_s2_(is_unchanged(wish, options) ? jump_.gravity_m_s2
                                                : options.gravity_m_s2),
      strength_m_s2_(gravity_m_s2_ * traits.strength_g.value_or(reference.strength_g())),
      time_scale_(time_scale(jump_.gravity_m_s2, gravity_m_s2_)),
      push_s_(wish.push_s.value_or(reference.push().duration_s() * time_scale_)),
      takeoff_(jump_.takeoff) {}

double JumpPlanner::above_floor_m(double height_m) const {
  return height_m - jump_.takeoff_feet_in_world.y;
}

Result<double> JumpPlanner::takeoff_speed() const {
  const double start_m = jump_.takeoff.p_in_world.y;
  std::optional<double> speed_m_s;
  if (wish_.apex_m || wish_.apex_by_m) {
    const double apex_m = wish_.apex_m ? *wish_.apex_m + jump_.takeoff_feet_in_world.y
                                       : jump_.apex_m + *wish_.apex_by_m;
    if (apex_m <= start_m) {
      return bad_input(wish_.apex_m ? "apex_m" : "apex_by_m",
                       "puts the apex " + metres(above_floor_m(apex_m)) +
                           " above the floor, not above the take-off at " +
                           metres(above_floor_m(start_m)),
                       wish_.apex_m
                           ? "choose more than " + metres(above_floor_m(start_m))
                           : "choose more than " + metres(start_m - jump_.apex_m));
    }
    speed_m_s = std::sqrt(2.0 * gravity_m_s2_ * (apex_m - start_m));
  }
  if (wish_.airtime_s) {
    const double fall_m = touchdown_->p_in_world.y - start_m;
    const double by_time_m_s =
        fall_m / *wish_.airtime_s + 0.5 * gravity_m_s2_ * *wish_.airtime_s;
    if (speed_m_s) {
      const double root = *speed_m_s * *speed_m_s - 2.0 * gravity_m_s2_ * fall_m;
      // A negative root is refused by solve_flight().
      const double airtime_s =
          root < 0.0 ? *wish_.airtime_s : (*speed_m_s + std::sqrt(root)) / gravity_m_s2_;
      if (std::abs(airtime_s - *wish_.airtime_s) > kSameTime_s) {
        return bad_input(
            "airtime_s",
            "contradicts the apex, from which the body lands after " + seconds(airtime_s),
            "leave one of the two out");
      }
    }
    if (by_time_m_s <= 0.0) {
      return bad_input(
          "airtime_s",
          "is too short for a fall of " + metres(-fall_m),
          "choose more than " + seconds(std::sqrt(2.0 * -fall_m / gravity_m_s2_)));
    }
    if (!speed_m_s) speed_m_s = by_time_m_s;
  }
  if (speed_m_s) return *speed_m_s;
  if (time_scale_ != 1.0 || !touchdown_ || moved_m_.y != 0.0) {
    // The captured rise, under the gravity of the plan.
    return jump_.takeoff.velocity_m_s.y * std::sqrt(gravity_m_s2_ / jump_.gravity_m_s2);
  }
  if (gravity_m_s2_ == jump_.gravity_m_s2) return jump_.takeoff.velocity_m_s.y;
  // The captured airtime: the capture falls at a wrong rate.
  const double airtime_s = jump_.touchdown->time_s - jump_.takeoff.time_s;
  return (touchdown_->p_in_world.y - start_m) / airtime_s +
         0.5 * gravity_m_s2_ * airtime_s;
}

Status JumpPlanner::solve_flight() {
  moved_m_ = landing_moved(jump_, wish_);
  if (jump_.touchdown) {
    touchdown_ = jump_.touchdown;
    touchdown_->p_in_world += moved_m_;
    rest_ = reference_.landing()->end;
    rest_->p_in_world += moved_m_;
  }
  const auto speed_m_s = takeoff_speed();
  if (!speed_m_s) return speed_m_s.error();
  takeoff_.time_s = jump_.start.time_s + push_s_;
  takeoff_.velocity_m_s.y = *speed_m_s;
  if (!touchdown_) return Done{};
  const double rise_m = touchdown_->p_in_world.y - takeoff_.p_in_world.y;
  const double root = *speed_m_s * *speed_m_s - 2.0 * gravity_m_s2_ * rise_m;
  if (root < 0.0) {
    const double needed_m = above_floor_m(touchdown_->p_in_world.y);
    return bad_input(
        "jump",
        "does not get that high: at touch-down the centre of mass is " +
            metres(needed_m) + " above the floor of the take-off, its apex " +
            metres(above_floor_m(takeoff_.p_in_world.y +
                                 0.5 * *speed_m_s * *speed_m_s / gravity_m_s2_)),
        "state apex_m of more than " + metres(needed_m) + ", or a lower landing");
  }
  const double flight_s = (*speed_m_s + std::sqrt(root)) / gravity_m_s2_;
  if (flight_s < kShortestFlight_s) {
    return bad_input("jump",
                     "has a flight of " + seconds(flight_s),
                     "wish for a flight of at least " + seconds(kShortestFlight_s));
  }
  touchdown_->time_s = takeoff_.time_s + flight_s;
  if (!wish_.length_m && !wish_.landing_in_world) keep_level_speed(flight_s);
  const glm::dvec3 way = touchdown_->p_in_world - takeoff_.p_in_world;
  takeoff_.velocity_m_s.x = way.x / flight_s;
  takeoff_.velocity_m_s.z = way.z / flight_s;
  touchdown_->velocity_m_s = takeoff_.velocity_m_s;
  touchdown_->velocity_m_s.y -= gravity_m_s2_ * flight_s;
  return Done{};
}

void JumpPlanner::keep_level_speed(double flight_s) {
  const double captured_s = jump_.touchdown->time_s - jump_.takeoff.time_s;
  glm::dvec3 way = jump_.touchdown->p_in_world - jump_.takeoff.p_in_world;
  way.y = 0.0;
  const glm::dvec3 farther = (flight_s / (captured_s * time_scale_) - 1.0) * way;
  moved_m_ += farther;
  touchdown_->p_in_world += farther;
  rest_->p_in_world += farther;
}

double JumpPlanner::deepest_m(const SupportPush& captured, double floor_m) const {
  const double takeoff_m = jump_.takeoff.p_in_world.y - jump_.takeoff_feet_in_world.y;
  return std::min(captured.lowest().height_m - kOverCaptured_m,
                  floor_m + kSquat * takeoff_m);
}

SupportWish JumpPlanner::push_wish(double speed_m_s) const {
  SupportWish out;
  out.start = jump_.start;
  out.end = takeoff_;
  out.end.velocity_m_s.y = speed_m_s;
  out.gravity_m_s2 = gravity_m_s2_;
  out.max_force_m_s2 = strength_m_s2_;
  out.deepest_m = traits_.deepest_m.value_or(
      deepest_m(reference_.push_model(), jump_.takeoff_feet_in_world.y));
  out.highest_m = std::max(reference_.push_model().highest_m(), out.end.p_in_world.y) +
                  kOverCaptured_m;
  out.friction = traits_.friction;
  out.law = options_.law;
  out.lowest = options_.lowest.value_or(reference_.push_model().lowest());
  return out;
}

Error JumpPlanner::push_refused() const {
  const auto speeds = possible_speeds(
      reference_.push(), push_wish(0.0), kMostSpeed * jump_.takeoff.velocity_m_s.y);
  const auto apex = [&](double speed_m_s) {
    return metres(above_floor_m(takeoff_.p_in_world.y +
                                0.5 * speed_m_s * speed_m_s / gravity_m_s2_));
  };
  std::string cause = "cannot be pushed in " + seconds(push_s_) + " with at most " +
                      format_text("%.2f g", strength_m_s2_ / gravity_m_s2_);
  if (options_.law == PushLawKind::kThesis) cause += " by the thesis law";
  if (!speeds) {
    return bad_input("jump",
                     cause + ", nor can any other apex",
                     options_.law == PushLawKind::kThesis
                         ? "use law = \"force\", or state another push_s"
                         : "state another push_s, or a larger strength_g");
  }
  return bad_input("jump",
                   cause,
                   "choose an apex between " + apex(speeds->low_m_s) + " and " +
                       apex(speeds->high_m_s) +
                       " above the floor, another push_s, or a larger strength_g");
}

void JumpPlanner::add_friction_finding(const char* phase) {
  findings_.push_back(
      fair_finding("friction",
                   phase,
                   "needs a horizontal force beyond the friction of the floor",
                   "choose a shorter length or a longer push"));
}

Status JumpPlanner::solve_push() {
  push_ = derive_support(reference_.push(), push_wish(takeoff_.velocity_m_s.y));
  if (!push_) return push_refused();
  const LowestPoint lowest = push_->lowest();
  if (options_.lowest && options_.law == PushLawKind::kThesis &&
      (std::abs(lowest.at - options_.lowest->at) > kOtherLowest ||
       std::abs(lowest.height_m - options_.lowest->height_m) > kOverCaptured_m)) {
    findings_.push_back(fair_finding(
        "lowest",
        "push",
        "the nearest possible lowest point has a height of " + metres(lowest.height_m),
        "choose a point of the search space"));
  }
  if (!push_->within_friction()) add_friction_finding("push");
  return Done{};
}

SupportWish JumpPlanner::landing_wish(double duration_s) const {
  SupportWish out;
  out.start = *touchdown_;
  out.end = *rest_;
  out.end.time_s = touchdown_->time_s + duration_s;
  out.gravity_m_s2 = gravity_m_s2_;
  out.max_force_m_s2 = std::max(
      strength_m_s2_, gravity_m_s2_ * kStrengthOfPeak * reference_.landing()->peak_g);
  const double floor_m =
      jump_.landing_feet_in_world.value_or(jump_.takeoff_feet_in_world).y;
  out.deepest_m =
      traits_.deepest_m.value_or(deepest_m(*reference_.landing_model(), floor_m)) +
      moved_m_.y;
  out.highest_m = reference_.landing_model()->highest_m() + moved_m_.y + kOverCaptured_m;
  out.friction = traits_.friction;
  return out;
}

Status JumpPlanner::solve_landing() {
  if (!touchdown_) {
    delay_s_ = takeoff_.time_s - jump_.takeoff.time_s;
    return Done{};
  }
  const double captured_s = reference_.landing()->duration_s() * time_scale_;
  for (const double factor : kLandingFactors) {
    double duration_s = factor * captured_s;
    delay_s_ = touchdown_->time_s + duration_s - reference_.landing()->end.time_s;
    if (options_.grid_s > 0.0) {
      const double rounded_s = options_.grid_s * std::round(delay_s_ / options_.grid_s);
      duration_s += rounded_s - delay_s_;
      delay_s_ = rounded_s;
    }
    if (duration_s <= 0.0) continue;
    landing_ =
        derive_support(reference_.landing() ? *reference_.landing() : reference_.push(),
                       landing_wish(duration_s));
    if (landing_) {
      rest_->time_s = touchdown_->time_s + duration_s;
      if (!landing_->within_friction()) add_friction_finding("landing");
      return Done{};
    }
  }
  return bad_input(
      "jump",
      "cannot be landed within " + seconds(kLandingFactors.back() * captured_s) +
          " at a speed of " + format_text("%.2f m/s", -touchdown_->velocity_m_s.y) +
          " with at most " +
          format_text("%.2f g", landing_wish(captured_s).max_force_m_s2 / gravity_m_s2_),
      "choose a lower apex, a higher landing, or a larger strength_g");
}

double JumpPlanner::change_m() const {
  double change =
      std::max({glm::length(moved_m_),
                std::abs(takeoff_.velocity_m_s.y - jump_.takeoff.velocity_m_s.y) * 0.1,
                std::abs(delay_s_),
                std::abs(push_s_ - reference_.push().duration_s())});
  if (touchdown_) {
    change = std::max(change,
                      std::abs((touchdown_->time_s - takeoff_.time_s) -
                               (jump_.touchdown->time_s - jump_.takeoff.time_s)));
  }
  return change;
}

std::vector<WarpKnot> JumpPlanner::warp_knots() const {
  std::vector<WarpKnot> knots{{jump_.start.time_s, jump_.start.time_s}};
  const auto add = [&](double time_s, double source_s) {
    if (time_s > knots.back().time_s + kKnotGap_s &&
        source_s > knots.back().source_s + kKnotGap_s) {
      knots.push_back({time_s, source_s});
    }
  };
  const auto require = [&](double time_s, double source_s) {
    while (knots.size() > 1 && (time_s <= knots.back().time_s + kKnotGap_s ||
                                source_s <= knots.back().source_s + kKnotGap_s)) {
      knots.pop_back();
    }
    knots.push_back({time_s, source_s});
  };
  const SupportPush& captured = reference_.push_model();
  add(jump_.start.time_s + push_->lowest().at * push_->duration_s(),
      jump_.start.time_s + captured.lowest().at * captured.duration_s());
  require(takeoff_.time_s, jump_.takeoff.time_s);
  add(takeoff_.time_s + std::max(0.0, takeoff_.velocity_m_s.y) / gravity_m_s2_,
      jump_.takeoff.time_s +
          std::max(0.0, jump_.takeoff.velocity_m_s.y) / jump_.gravity_m_s2);
  if (!touchdown_) return knots;
  require(touchdown_->time_s, jump_.touchdown->time_s);
  const SupportPush& landing = *reference_.landing_model();
  add(touchdown_->time_s + landing_->lowest().at * landing_->duration_s(),
      jump_.touchdown->time_s + landing.lowest().at * landing.duration_s());
  require(rest_->time_s, reference_.landing()->end.time_s);
  return knots;
}

Result<JumpPlan> JumpPlanner::plan() {
  if (const Status ok = check_jump_wish(reference_, wish_, traits_, options_); !ok) {
    return ok.error();
  }
  for (const auto step : {&JumpPlanner::solve_flight,
                          &JumpPlanner::solve_push,
                          &JumpPlanner::solve_landing}) {
    if (const Status ok = (this->*step)(); !ok) return ok.error();
  }
  JumpPlan out(reference_, warp_knots());
  const bool same_gravity = gravity_m_s2_ == jump_.gravity_m_s2;
  const double change = change_m();
  out.is_identity_ = same_gravity && !options_.ballistic && change < kNoChange_m &&
                     options_.law == PushLawKind::kForce;
  out.start_ = jump_.start;
  out.takeoff_ = takeoff_;
  out.touchdown_ = touchdown_;
  out.rest_ = rest_;
  out.gravity_m_s2_ = gravity_m_s2_;
  out.landing_moved_m_ = moved_m_;
  out.delay_s_ = delay_s_;
  const double gone_m =
      std::max(kResidualGone_m, kResidualGoneFactor * reference_.flight_residual_m());
  const double x = std::clamp(change / gone_m, 0.0, 1.0);
  out.flight_residual_share_ =
      options_.ballistic || !same_gravity ? 0.0 : 1.0 - x * x * (3.0 - 2.0 * x);
  out.push_ = *push_;
  out.landing_ = landing_;
  out.findings_ = std::move(findings_);
  return out;
}

}  // namespace marey::dynamics
