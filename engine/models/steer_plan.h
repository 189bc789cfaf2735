// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/clips/sample_clip.h"
#include "engine/models/clip_travel.h"
#include "engine/models/steer_settings.h"
#include <glm/vec2.hpp>

#include "core/base/result.h"
#include "core/engine/motion_clip.h"

namespace marey::engine {

/// Question to ask_steer(): the state from which the course would start.
struct SteerQuestion {
  RootPlace root{};
  double clip_s = 0.0;
  double rate = 1.0;  ///< Clip seconds per second: > 0.
  double leg_length_m = 1.0;
  glm::dvec2 goal_xz_m{0.0};  ///< World.
};

struct SteerAnswer {
  /// The course arrives within max_duration_s.
  bool reachable = false;
  int steps = 0;            ///< Landings; 0: it is there already.
  double duration_s = 0.0;  ///< Until the last landing.
  double distance_m = 0.0;  ///< Length of the course: the sum of its steps.
  double missing_m = 0.0;   ///< Distance to the goal at the end.
};

/// Predicts a course without playing it (figure 7.9). Some 3 us; up to 40 us for a goal
/// within the circle of the tightest turn of a runner. Allocates nothing.
/// Errors (bad input): a number that is not finite, rate or leg length <= 0.
[[nodiscard]] Result<SteerAnswer> ask_steer(const MotionClip& clip,
                                            const ClipTravel& travel,
                                            const SteerQuestion& question,
                                            const SteerSettings& settings = {});

/// Returns SteerAnswer::steps, or -1 if the goal is not reachable. Errors: ask_steer()'s.
[[nodiscard]] Result<int> steps_to(const MotionClip& clip,
                                   const ClipTravel& travel,
                                   const SteerQuestion& question,
                                   const SteerSettings& settings = {});

}  // namespace marey::engine
