// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "engine/models/steer_course.h"
#include <glm/vec2.hpp>

#include "core/engine/motion_clip.h"

namespace marey::engine {

/// A gait from which a clip is made. Lengths in legs.
struct Gait {
  int steps = 2;  ///< For a cycle; even.
  double step_legs = 0.75;
  double step_s = 0.55;
  double alone_share = 0.7;  ///< For a step in which one foot stands alone.
  bool runs = false;         ///< The rest of the step is flight instead of both feet.
  double width_legs = 0.12;
  double sway_legs = 0.0;
  double travel_rad = 0.0;  ///< Direction of travel relative to the heading.
  double turn_rad = 0.0;    ///< For the path, per step.
  double irregular = 0.0;   ///< Deviation of single steps, relative to the step.
  bool stays = false;       ///< Every second step leads back: a dance on the spot.
  bool mirrored = false;
  std::uint32_t seed = 1;
};

/// A walker whose footprints are known: the truth of the tests.
class MadeWalker {
 public:
  explicit MadeWalker(const Gait& gait);

  [[nodiscard]] const MotionClip& clip() const { return clip_; }
  [[nodiscard]] bool bears(std::size_t foot, double clip_s) const;
  /// Time from `clip_s` to the next change of a foot. [s]
  [[nodiscard]] double until_edge_s(std::size_t foot, double clip_s) const;
  /// Foot relative to the root of the clip, in its heading frame. [legs]
  [[nodiscard]] glm::dvec2 foot_from_root(std::size_t foot, double clip_s) const;

 private:
  struct Stance {
    double start_s = 0.0, end_s = 0.0;
    glm::dvec2 place_legs{0.0};
  };
  [[nodiscard]] const Stance& stance_before(std::size_t foot, double clip_s) const;

  MotionClip clip_;
  std::array<std::vector<Stance>, 2> stances_;  ///< Several cycles, ascending.
};

/// One step of a run.
struct WalkedStep {
  double time_s = 0.0;
  RootPlace root;  ///< Steered.
  SteerStep out;
  std::array<bool, 2> bears{};
};

/// Figures of a course, computed by the walker without use of the model's state.
struct Walked {
  std::vector<WalkedStep> steps;
  bool arrived = false;
  double distance_m = 0.0;  ///< At the end.
  double duration_s = 0.0;
  int landings = 0;
  double max_turn_rad = 0.0;  ///< For one time in which a foot stands alone.
  double max_turn_rad_s = 0.0;
  double turn_with_both_rad = 0.0;  ///< While not one foot alone bears.
  double foot_error_m = 0.0;        ///< For standing feet; see walk().
  double max_shift_of_step = 0.0;   ///< Relative to the clip's mean step.
  double max_twist_rad = 0.0;       ///< For a standing foot against the hips' turn.
  double twist_error_rad = 0.0;     ///< Against the reported twist.
};

struct WalkOptions {
  double step_s = 1.0 / 60.0;
  double max_s = 70.0;
  double rate = 1.0;
  double leg_length_m = 0.9;
  double start_clip_s = 0.0;
  RootPlace start;
};

/// Goal at a time since the start. [m]
using GoalAt = std::function<glm::dvec2(double time_s)>;

/// Plays the walker with the course until it has arrived or is out of time. A standing
/// foot is held where it landed; `foot_error_m` is the largest deviation of the foot that
/// moves with the root from it, after the root's shift since the landing is taken off.
[[nodiscard]] Walked walk(const MadeWalker& walker,
                          SteerCourse& course,
                          const GoalAt& goal,
                          const WalkOptions& options);

/// A number in [low, high) from a seed.
class MadeNumbers {
 public:
  explicit MadeNumbers(std::uint32_t seed) : state_(seed * 2654435761U + 12345U) {}
  double next(double low, double high);

 private:
  std::uint32_t state_;
};

}  // namespace marey::engine
