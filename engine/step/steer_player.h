// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "engine/actions/action.h"
#include "engine/models/clip_travel.h"
#include "engine/models/steer_course.h"
#include "engine/step/blend_player.h"
#include <glm/vec2.hpp>

#include "core/base/result.h"

namespace marey::engine {

/// A request to walk to a goal: an action whose clip loops, and the goal on the floor.
struct SteerWish {
  ActionWish action;
  glm::dvec2 goal_xz_m{0.0};
  SteerSettings settings;
};

/// Leads one action of a character to its goal by turning the root about standing feet.
class SteerPlayer {
 public:
  /// Errors (bad input): those of travel_of_clip() and SteerCourse; a goal that is not
  /// finite. `base` must outlive it.
  [[nodiscard]] static Result<SteerPlayer> make(const MotionBase& base,
                                                ActionId action,
                                                std::size_t clip,
                                                const SteerWish& wish);

  [[nodiscard]] ActionId action() const { return action_; }
  [[nodiscard]] Status aim(glm::dvec2 goal_xz_m) { return course_.aim(goal_xz_m); }

  /// Turns and moves the root of this step. `ankle_xz_m`, `bears`: the feet as they
  /// stand. The action fades out when it arrives.
  void step(double time_s,
            double step_s,
            const std::array<glm::dvec2, 2>& ankle_xz_m,
            const std::array<bool, 2>& bears,
            BlendPlayer& blend);

  /// The changes of the last step, and whether it has arrived.
  [[nodiscard]] const SteerStep& last() const { return last_; }

 private:
  SteerPlayer() = default;
  ActionId action_{};
  std::size_t clip_ = 0;
  // On the heap: the course refers to it.
  std::unique_ptr<ClipTravel> travel_;
  SteerCourse course_;
  SteerStep last_;
};

}  // namespace marey::engine
