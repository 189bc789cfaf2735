// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/steer_forecast.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace marey::engine {
namespace {

constexpr double kWholeTurn_rad = 2.0 * 3.14159265358979323846;

// The moment of the next step, after a move.
SteerMoment after(const SteerScene& scene,
                  const SteerMoment& moment,
                  const SteerMove& move) {
  const ClipTravel& travel = *scene.travel;
  SteerMoment next;
  next.step = moment.step + 1 < travel.steps.size() ? moment.step + 1 : 0;
  const ClipStep& step = travel.steps[next.step];
  const double course_rad = moment.course_rad + move.turn_rad;
  const glm::dvec2 by_m =
      scene.leg_length_m * turned({step.across_legs, step.along_legs}, course_rad);
  next.pivot_xz_m = move.end_xz_m + step.passes_at * by_m;
  next.end_xz_m = move.end_xz_m + by_m;
  next.course_rad = course_rad + step.turn_rad;
  const double limit_rad =
      scene.turn_share * max_turn_of(scene, step.alone_end_s - step.alone_start_s);
  next.turn_rad = {-limit_rad, limit_rad};
  double clip_s = step.land_s - travel.steps[moment.step].land_s;
  if (next.step <= moment.step) clip_s += travel.cycle_s;
  next.land_s = clip_s / scene.rate;
  return next;
}

// Leaves out the straight middle of a long course.
void skip_straight_steps(const SteerScene& scene,
                         int count,
                         SteerMoment& moment,
                         SteerMove& move,
                         SteerForecast& out) {
  const ClipTravel& travel = *scene.travel;
  const glm::dvec2 sum_m = scene.leg_length_m * sum_of_steps(travel, moment.step, count);
  move.end_xz_m += turned(sum_m, moment.course_rad + move.turn_rad);
  const std::size_t last = moment.step + static_cast<std::size_t>(count);
  const auto cycles = static_cast<double>(last / travel.steps.size());
  const std::size_t step = last % travel.steps.size();
  out.steps += count;
  out.distance_m += glm::length(sum_m);
  out.duration_s += (cycles * travel.cycle_s + travel.steps[step].land_s -
                     travel.steps[moment.step].land_s) /
                    scene.rate;
  moment.step = step;
}

// Radius of the tightest circle of whole steps.
double turn_radius_m(const SteerScene& scene, double scale) {
  const double turn_rad =
      scene.turn_share * max_turn_of(scene, scene.travel->mean_alone_s);
  return 0.5 * scale * mean_along_m(scene) / std::max(std::sin(0.5 * turn_rad), 1e-6);
}

// Straight steps after which the goal is outside of the circle; 0: it is.
int steps_out_of_circle(const SteerScene& scene,
                        const SteerMoment& moment,
                        double scale) {
  const double radius_m = turn_radius_m(scene, scale);
  const glm::dvec2 along = turned({0.0, 1.0}, moment.course_rad);
  const glm::dvec2 side = turned({1.0, 0.0}, moment.course_rad);
  const glm::dvec2 goal_m = scene.goal_xz_m - moment.pivot_xz_m;
  const double ahead_m = glm::dot(goal_m, along);
  const double from_centre_m = std::abs(glm::dot(goal_m, side)) - radius_m;
  const double rest = radius_m * radius_m - from_centre_m * from_centre_m;
  if (ahead_m * ahead_m >= rest) return 0;
  return static_cast<int>(std::ceil((ahead_m + std::sqrt(rest)) / mean_along_m(scene)));
}

}  // namespace

SteerForecast forecast(const SteerScene& scene,
                       const SteerMoment& start,
                       const SteerStrategy& strategy) {
  // A course that has turned around once and has not found the goal goes on in circles.
  const double limit_rad = max_turn_of(scene, scene.travel->mean_alone_s);
  const int max_steps =
      scene.travel->travels
          ? 10 + static_cast<int>(1.3 * kWholeTurn_rad / std::max(limit_rad, 0.05))
          : 200;
  SteerMoment moment = start;
  SteerStrategy rest = strategy;
  SteerForecast out;
  for (int i = 0; i < max_steps; ++i) {
    SteerMove move = choose_move(scene, moment, rest);
    ++out.steps;
    out.duration_s += moment.land_s;
    out.missing_m = move.missing_m;
    out.distance_m += scene.leg_length_m * scene.travel->steps[moment.step].length_legs;
    if (move.is_last) {
      out.arrives = true;
      return out;
    }
    if (out.duration_s > scene.settings->max_duration_s) return out;
    if (rest.straight_steps > 0) --rest.straight_steps;
    if (move.is_aligned && move.further_steps > kScaledSteps + 1) {
      const int skip = move.further_steps - kScaledSteps;
      skip_straight_steps(scene, skip, moment, move, out);
    }
    moment = after(scene, moment, move);
  }
  return out;
}

namespace {

// The strategy that arrives first.
SteerStrategy first_to_arrive(const SteerScene& scene,
                              const SteerMoment& moment,
                              SteerForecast& predicted) {
  SteerStrategy best;
  const auto consider = [&](const SteerStrategy& strategy) {
    const SteerForecast other = forecast(scene, moment, strategy);
    const bool is_better =
        other.arrives && (!predicted.arrives || other.duration_s < predicted.duration_s);
    if (!is_better && predicted.steps > 0) return;
    best = strategy;
    predicted = other;
  };
  // A goal well within the circle is left out: the course would go around it without end.
  constexpr double kWell = 0.6;
  const double tight = scene.settings->min_scale;
  predicted = {};
  const bool is_close =
      glm::length(scene.goal_xz_m - moment.pivot_xz_m) < 3.0 * mean_along_m(scene);
  if (!scene.travel->travels || is_close ||
      steps_out_of_circle(scene, moment, kWell) == 0) {
    consider({});
    const bool is_too_far = predicted.duration_s > scene.settings->max_duration_s;
    if (predicted.arrives || !scene.travel->travels || is_too_far) return best;
  }
  if (steps_out_of_circle(scene, moment, kWell * tight) == 0) consider({0, true});
  for (const bool is_tight : {true, false}) {
    const int steps = steps_out_of_circle(scene, moment, is_tight ? tight : 1.0);
    for (int more = 0; more < 3 && !predicted.arrives; ++more) {
      consider({std::max(steps, 1) + more, is_tight});
    }
  }
  if (!predicted.arrives) {
    best = {};
    predicted = forecast(scene, moment, {});
  }
  return best;
}

}  // namespace

SteerStrategy best_strategy(const SteerScene& scene,
                            const SteerMoment& moment,
                            SteerForecast& predicted) {
  SteerScene careful = scene;
  careful.turn_share = 0.93;
  SteerMoment first = moment;
  first.turn_rad.low *= careful.turn_share;
  first.turn_rad.high *= careful.turn_share;
  const SteerStrategy best = first_to_arrive(careful, first, predicted);
  const bool is_too_far = predicted.duration_s > scene.settings->max_duration_s;
  if (predicted.arrives || is_too_far || !scene.travel->travels) return best;
  SteerScene near = scene;
  near.arrival_m = kNear_m;
  return first_to_arrive(near, moment, predicted);
}

}  // namespace marey::engine
