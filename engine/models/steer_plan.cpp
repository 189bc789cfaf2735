// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/steer_plan.h"

#include <cmath>

#include "engine/models/steer_forecast.h"
#include "engine/models/steer_moves.h"
#include <glm/geometric.hpp>

namespace marey::engine {
namespace {

bool is_finite(const SteerQuestion& question) {
  return std::isfinite(question.root.x_m) && std::isfinite(question.root.z_m) &&
         std::isfinite(question.root.heading_rad) && std::isfinite(question.clip_s) &&
         std::isfinite(question.goal_xz_m.x) && std::isfinite(question.goal_xz_m.y);
}

bool is_positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

}  // namespace

Result<SteerAnswer> ask_steer(const MotionClip& clip,
                              const ClipTravel& travel,
                              const SteerQuestion& question,
                              const SteerSettings& settings) {
  if (!is_finite(question)) {
    return bad_input("steer " + clip.name,
                     "the goal, the root or the time is not a finite number",
                     "give the goal in metres");
  }
  if (!is_positive(question.rate) || !is_positive(question.leg_length_m)) {
    return bad_input("steer " + clip.name,
                     "the rate and the leg length must be positive",
                     "give a rate in clip seconds per second, such as 1");
  }
  const SteerScene scene{&clip,
                         &travel,
                         &settings,
                         question.leg_length_m,
                         question.rate,
                         question.goal_xz_m};
  const NextLanding landing = next_landing(travel, question.clip_s);
  const SteerMoment moment =
      moment_of(scene, question.root, question.clip_s, landing.clip_s, landing.step);
  const glm::dvec2 root_xz_m{question.root.x_m, question.root.z_m};
  SteerAnswer answer;
  if (is_arrival(scene, root_xz_m, moment, true)) {
    answer.reachable = true;
    answer.missing_m = glm::length(question.goal_xz_m - root_xz_m);
    return answer;
  }
  SteerForecast predicted;
  static_cast<void>(best_strategy(scene, moment, predicted));
  answer.reachable = predicted.arrives && predicted.duration_s <= settings.max_duration_s;
  answer.steps = predicted.steps;
  answer.duration_s = predicted.duration_s;
  answer.distance_m = predicted.distance_m;
  answer.missing_m = predicted.missing_m;
  return answer;
}

Result<int> steps_to(const MotionClip& clip,
                     const ClipTravel& travel,
                     const SteerQuestion& question,
                     const SteerSettings& settings) {
  const Result<SteerAnswer> answer = ask_steer(clip, travel, question, settings);
  if (!answer) return answer.error();
  return answer->reachable ? answer->steps : -1;
}

}  // namespace marey::engine
