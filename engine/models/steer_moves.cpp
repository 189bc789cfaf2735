// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/steer_moves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

namespace marey::engine {
namespace {

constexpr double kPi = 3.14159265358979323846;
// A goal this close to straight behind has no side: the swinging foot decides.
constexpr double kBehind_rad = kPi - 0.1;
// Turns that remain below it are left to the next steps.
constexpr double kAligned_rad = 0.03;
// Landings of a clip with uneven steps that are tried around the likely one.
constexpr int kUnevenSteps = 12;
// A root that lands within this share of a step has arrived.
constexpr double kArrivalShare = 0.12;
constexpr double kArrival_m = 0.03;
// A clip that does not travel arrives within it, or within half a step.
constexpr double kDriftArrival_m = 0.15;

double heading_of(glm::dvec2 xz) {
  return std::atan2(xz.x, xz.y);
}

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * kPi);
}

const ClipStep& step_at(const SteerScene& scene, std::size_t step) {
  return scene.travel->steps[step];
}

double arrival_m(const SteerScene& scene) {
  if (scene.arrival_m > 0.0) return scene.arrival_m;
  if (!scene.travel->travels) {
    return std::min(kDriftArrival_m,
                    0.5 * scene.travel->mean_step_legs * scene.leg_length_m);
  }
  return std::max(kArrival_m,
                  kArrivalShare * scene.travel->mean_step_legs * scene.leg_length_m);
}

// The landing at which a course turned towards the goal ends.
struct Ending {
  int further = 0;
  glm::dvec2 end_xz_m{0.0};  ///< Without turn.
  double longer_m = 0.0;     ///< Necessary increase of the steps up to it.
  double along_m = 0.0;      ///< Their length.
};

class EndingSearch {
 public:
  EndingSearch(const SteerScene& scene, const SteerMoment& moment)
      : scene_(scene),
        moment_(moment),
        along_(turned({0.0, 1.0}, moment.course_rad)),
        across_(along_.y, -along_.x),
        goal_m_(glm::length(scene.goal_xz_m - moment.pivot_xz_m)) {}

  // The ending whose steps change least.
  [[nodiscard]] Ending best() const {
    const double first_m = at(0).longer_m;
    const auto estimate = static_cast<int>(
        std::clamp(std::round(first_m / mean_along_m(scene_)), 0.0, 1e6));
    return scene_.travel->is_even ? nearest(estimate) : best_around(estimate);
  }

 private:
  // For even steps, which change less the closer they end.
  [[nodiscard]] Ending nearest(int further) const {
    Ending ending = at(further);
    for (const int by : {-1, 1}) {
      while (further + by >= 0) {
        const Ending other = at(further + by);
        if (change(other) >= change(ending)) break;
        ending = other;
        further += by;
      }
    }
    return ending;
  }

  [[nodiscard]] Ending best_around(int estimate) const {
    const int by = std::min(static_cast<int>(scene_.travel->steps.size()), kUnevenSteps);
    Ending best = at(std::max(estimate - by, 0));
    for (int further = best.further + 1; further <= estimate + by; ++further) {
      const Ending other = at(further);
      if (change(other) < change(best)) best = other;
    }
    return best;
  }

  [[nodiscard]] Ending at(int further) const {
    const glm::dvec2 sum_m =
        scene_.leg_length_m * sum_of_steps(*scene_.travel, moment_.step, further);
    Ending out;
    out.further = further;
    out.end_xz_m = moment_.end_xz_m + sum_m.x * across_ + sum_m.y * along_;
    out.along_m =
        sum_m.y + scene_.leg_length_m * step_at(scene_, moment_.step).along_legs;
    out.longer_m = goal_m_ - glm::length(out.end_xz_m - moment_.pivot_xz_m);
    return out;
  }

  [[nodiscard]] static double change(const Ending& ending) {
    const double along_m = std::max(ending.along_m, 0.01);
    return std::abs(std::log(std::max(1.0 + ending.longer_m / along_m, 0.01)));
  }

  const SteerScene& scene_;
  const SteerMoment& moment_;
  glm::dvec2 along_;
  glm::dvec2 across_;
  double goal_m_ = 0.0;
};

glm::dvec2 limited(glm::dvec2 v, double max_length) {
  const double length = glm::length(v);
  return length > max_length ? v * (max_length / length) : v;
}

// Shift within the limits of the step's length, in any direction.
glm::dvec2 permitted_shift(const SteerScene& scene,
                           const SteerMoment& moment,
                           glm::dvec2 shift_m) {
  const double step_m = scene.leg_length_m * step_at(scene, moment.step).length_legs;
  const glm::dvec2 along = turned({0.0, 1.0}, moment.course_rad);
  const double limit = glm::dot(shift_m, along) < 0.0 ? 1.0 - scene.settings->min_scale
                                                      : scene.settings->max_scale - 1.0;
  return limited(shift_m, limit * step_m);
}

void finish(const SteerScene& scene, const SteerMoment& moment, SteerMove& move) {
  const glm::dvec2 arm = moment.end_xz_m + move.shift_xz_m - moment.pivot_xz_m;
  move.end_xz_m = moment.pivot_xz_m + turned(arm, move.turn_rad);
  move.missing_m = glm::length(scene.goal_xz_m - move.end_xz_m);
}

// The step that ends at the goal with this turn.
SteerMove last_move(const SteerScene& scene, const SteerMoment& moment, double turn_rad) {
  SteerMove move;
  move.turn_rad = turn_rad;
  const glm::dvec2 goal_m = turned(scene.goal_xz_m - moment.pivot_xz_m, -turn_rad);
  move.shift_xz_m =
      permitted_shift(scene, moment, moment.pivot_xz_m + goal_m - moment.end_xz_m);
  finish(scene, moment, move);
  move.is_last = move.missing_m <= arrival_m(scene);
  return move;
}

// The best of no turn, half of it and the whole turn to the goal; a turn costs a
// tenth of a step per radian.
SteerMove best_last_move(const SteerScene& scene,
                         const SteerMoment& moment,
                         double turn_rad) {
  SteerMove best = last_move(scene, moment, turn_rad);
  const double price_m = 0.1 * scene.travel->mean_step_legs * scene.leg_length_m;
  for (const double share : {0.5, 0.0}) {
    const double turn =
        std::clamp(share * turn_rad, moment.turn_rad.low, moment.turn_rad.high);
    const SteerMove other = last_move(scene, moment, turn);
    if (other.missing_m + price_m * std::abs(other.turn_rad) <
        best.missing_m + price_m * std::abs(best.turn_rad)) {
      best = other;
    }
  }
  return best;
}

// A clip without a direction is shifted to the goal and never turned.
SteerMove drift(const SteerScene& scene, const SteerMoment& moment) {
  SteerMove move;
  move.shift_xz_m = permitted_shift(scene, moment, scene.goal_xz_m - moment.end_xz_m);
  finish(scene, moment, move);
  move.is_last = move.missing_m <= arrival_m(scene);
  const double each_m = (scene.settings->max_scale - 1.0) * scene.travel->mean_step_legs *
                        scene.leg_length_m;
  move.further_steps =
      move.is_last ? 0 : 1 + static_cast<int>(move.missing_m / std::max(each_m, 1e-3));
  return move;
}

double turn_to_goal(const SteerScene& scene,
                    const SteerMoment& moment,
                    const Ending& ending) {
  const glm::dvec2 goal = scene.goal_xz_m - moment.pivot_xz_m;
  const glm::dvec2 end = ending.end_xz_m - moment.pivot_xz_m;
  if (glm::length(goal) < 1e-6 || glm::length(end) < 1e-6) return 0.0;
  const double turn_rad = wrapped(heading_of(goal) - heading_of(end));
  if (std::abs(turn_rad) < kBehind_rad) return turn_rad;
  // Towards the swinging foot: the left one is at +X of a body that faces +Z.
  const bool left_swings = step_at(scene, moment.step).stands == PhaseClass::kRight;
  return left_swings ? std::abs(turn_rad) : -std::abs(turn_rad);
}

// The turn to a goal for which one step is by far not enough, without a search of the
// landing; nullopt: the goal is close or ahead.
std::optional<double> far_turn(const SteerScene& scene, const SteerMoment& moment) {
  constexpr double kMore_rad = 0.5;
  if (!scene.travel->is_even) return std::nullopt;
  const glm::dvec2 goal = scene.goal_xz_m - moment.pivot_xz_m;
  const double near_m = 3.0 * mean_along_m(scene);
  if (glm::dot(goal, goal) < near_m * near_m) return std::nullopt;
  const double turn_rad = wrapped(heading_of(goal) - moment.course_rad);
  const bool is_far = std::abs(turn_rad) < kBehind_rad - 0.2 &&
                      (turn_rad > moment.turn_rad.high + kMore_rad ||
                       turn_rad < moment.turn_rad.low - kMore_rad);
  return is_far ? std::optional(turn_rad) : std::nullopt;
}

}  // namespace

double max_turn_of_step(const SteerSettings& settings, double turn_s) {
  // The rate of smooth_step is 15/8 of its mean; permitted_targets() keeps 1 % back.
  constexpr double kPeak = 1.875 / 0.99;
  return std::min(settings.max_turn_rad,
                  settings.max_turn_rad_s * std::max(turn_s, 0.0) / kPeak);
}

double max_turn_of(const SteerScene& scene, double alone_clip_s) {
  // It is seen up to a step late, and the turn ends a step early.
  return max_turn_of_step(*scene.settings,
                          alone_clip_s / scene.rate - 1.5 * scene.step_s);
}

glm::dvec2 turned(glm::dvec2 xz_m, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return {c * xz_m.x + s * xz_m.y, c * xz_m.y - s * xz_m.x};
}

glm::dvec2 sum_of_steps(const ClipTravel& travel, std::size_t step, int further) {
  const std::size_t count = travel.steps.size();
  const std::size_t last = step + static_cast<std::size_t>(further);
  const auto cycles = static_cast<double>(last / count);
  const ClipStep& total = travel.steps.back();
  const ClipStep& from = travel.steps[step];
  const ClipStep& to = travel.steps[last % count];
  return {to.sum_across_legs - from.sum_across_legs + cycles * total.sum_across_legs,
          to.sum_along_legs - from.sum_along_legs + cycles * total.sum_along_legs};
}

double mean_along_m(const SteerScene& scene) {
  const ClipTravel& travel = *scene.travel;
  return std::max(travel.steps.back().sum_along_legs /
                      static_cast<double>(travel.steps.size()) * scene.leg_length_m,
                  1e-4);
}

NextLanding next_landing(const ClipTravel& travel, double clip_s) {
  const double cycle_s = travel.cycle_s;
  double offset_s = std::floor(clip_s / cycle_s) * cycle_s - cycle_s;
  // Landings are up to a cycle later than the start of their step.
  for (;; offset_s += cycle_s) {
    for (std::size_t i = 0; i < travel.steps.size(); ++i) {
      const double land_s = travel.steps[i].land_s + offset_s;
      if (land_s > clip_s + 1e-6) return {i, land_s};
    }
  }
}

NextLanding nearest_landing(const ClipTravel& travel, double clip_s) {
  const NextLanding later = next_landing(travel, clip_s);
  const std::size_t count = travel.steps.size();
  NextLanding earlier;
  earlier.step = later.step > 0 ? later.step - 1 : count - 1;
  earlier.clip_s = later.clip_s + travel.steps[earlier.step].land_s -
                   travel.steps[later.step].land_s -
                   (later.step > 0 ? 0.0 : travel.cycle_s);
  return clip_s - earlier.clip_s < later.clip_s - clip_s ? earlier : later;
}

SteerMoment moment_of(const SteerScene& scene,
                      const RootPlace& root,
                      double clip_s,
                      double land_clip_s,
                      std::size_t step) {
  const ClipTravel& travel = *scene.travel;
  // In the first cycle path_at() does not sum up cycles.
  const double cycles_s = std::floor(clip_s / travel.cycle_s) * travel.cycle_s;
  RootPlace by = relative(path_at(*scene.clip, clip_s - cycles_s),
                          path_at(*scene.clip, land_clip_s - cycles_s));
  by.x_m *= scene.leg_length_m;
  by.z_m *= scene.leg_length_m;
  const RootPlace end = moved(root, by);
  SteerMoment out;
  out.end_xz_m = {end.x_m, end.z_m};
  out.course_rad = end.heading_rad + travel_direction(*scene.clip, travel, land_clip_s);
  out.step = step;
  const ClipStep& s = travel.steps[step];
  const double ahead_m = (1.0 - s.passes_at) * scene.leg_length_m;
  out.pivot_xz_m =
      out.end_xz_m - ahead_m * turned({s.across_legs, s.along_legs}, out.course_rad);
  const double left_s = s.alone_end_s - s.land_s + land_clip_s - clip_s;
  const double limit_rad =
      max_turn_of(scene, std::min(left_s, s.alone_end_s - s.alone_start_s));
  out.turn_rad = {-limit_rad, limit_rad};
  out.land_s = (land_clip_s - clip_s) / scene.rate;
  return out;
}

SteerMove choose_move(const SteerScene& scene,
                      const SteerMoment& moment,
                      const SteerStrategy& strategy) {
  if (!scene.travel->travels) return drift(scene, moment);
  const auto permitted = [&](double turn_rad) {
    return std::clamp(turn_rad, moment.turn_rad.low, moment.turn_rad.high);
  };
  SteerMove move;
  if (strategy.straight_steps > 0) {
    move.turn_rad = permitted(-step_at(scene, moment.step).turn_rad);
    move.further_steps = strategy.straight_steps;
    finish(scene, moment, move);
    return move;
  }
  Ending ending;
  double wanted_rad = 0.0;
  if (const auto rough_rad = far_turn(scene, moment)) {
    wanted_rad = *rough_rad;
    ending.further = kScaledSteps;
  } else {
    ending = EndingSearch(scene, moment).best();
    wanted_rad = turn_to_goal(scene, moment, ending);
  }
  move.turn_rad = permitted(wanted_rad);
  if (ending.further == 0) {
    const SteerMove last = best_last_move(scene, moment, move.turn_rad);
    if (last.is_last) return last;
  }
  move.further_steps = ending.further;
  move.is_aligned = std::abs(wanted_rad - move.turn_rad) < kAligned_rad;
  const double step_m = scene.leg_length_m * step_at(scene, moment.step).along_legs;
  double longer_m = 0.0;
  if (move.is_aligned && ending.further < kScaledSteps && ending.along_m > 0.01) {
    longer_m = ending.longer_m * std::max(step_m, 0.0) / ending.along_m;
  } else if (!move.is_aligned && strategy.is_tight) {
    longer_m = (scene.settings->min_scale - 1.0) * std::max(step_m, 0.0);
  }
  move.shift_xz_m =
      permitted_shift(scene, moment, longer_m * turned({0.0, 1.0}, moment.course_rad));
  finish(scene, moment, move);
  return move;
}

bool is_arrival(const SteerScene& scene,
                glm::dvec2 root_xz_m,
                const SteerMoment& moment,
                bool not_begun) {
  const double distance_m = glm::length(scene.goal_xz_m - root_xz_m);
  const double half_m = 0.5 * scene.travel->mean_step_legs * scene.leg_length_m;
  if (distance_m <= kArrival_m) return true;
  if (distance_m > half_m || (distance_m > kNear_m && !not_begun)) return false;
  // A step that gains less than a fifth is not worth taking.
  return choose_move(scene, moment, {}).missing_m > 0.8 * distance_m;
}

}  // namespace marey::engine
