// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "engine/clips/sample_clip.h"
#include "engine/models/clip_travel.h"
#include "engine/models/steer_settings.h"
#include "engine/models/swing_curve.h"
#include <glm/vec2.hpp>

#include "core/engine/motion_clip.h"

namespace marey::engine {

// The plan of a steered course, step by step. Places on the floor are (x, z) in the
// world. [m] Angles are headings: 0 faces +Z, positive turns towards +X.

/// Number of last steps that share a difference in length, at most.
inline constexpr int kScaledSteps = 5;

/// A course that misses its goal by less does not turn back. [m]
inline constexpr double kNear_m = 0.17;

/// Everything that stays the same over a course.
struct SteerScene {
  const MotionClip* clip = nullptr;
  const ClipTravel* travel = nullptr;  ///< For the clip.
  const SteerSettings* settings = nullptr;
  double leg_length_m = 1.0;
  double rate = 1.0;  ///< Clip seconds per second.
  glm::dvec2 goal_xz_m{0.0};
  double step_s = 1.0 / 60.0;  ///< For the engine.
  /// Share of the permitted turn that predictions use: the rest corrects their errors.
  double turn_share = 1.0;
  /// A last step that ends within this distance ends at the goal; 0: the usual one. [m]
  double arrival_m = 0.0;
};

/// A step that is to be planned.
struct SteerMoment {
  glm::dvec2 pivot_xz_m{0.0};  ///< The foot that stands alone.
  glm::dvec2 end_xz_m{0.0};    ///< Root at the landing, without turn and shift.
  double course_rad = 0.0;     ///< Direction of travel at the landing, without turn.
  CurveRange turn_rad;         ///< Permitted turns; contains 0 or is narrow about it.
  std::size_t step = 0;        ///< In ClipTravel::steps.
  double land_s = 0.0;         ///< Time until the landing.
};

/// Turn and shift of a step: the root lands at
/// pivot + R(turn) (end + shift - pivot).
struct SteerMove {
  double turn_rad = 0.0;
  glm::dvec2 shift_xz_m{0.0};
  glm::dvec2 end_xz_m{0.0};  ///< Place at which the root lands.
  int further_steps = 0;     ///< After this one, about.
  bool is_aligned = false;   ///< Later steps need no turn.
  bool is_last = false;      ///< The step ends at the goal.
  double missing_m = 0.0;    ///< From the landing to the goal.
};

/// Deviations from turning to the goal at once: for a goal within the circle of the
/// tightest turn.
struct SteerStrategy {
  int straight_steps = 0;  ///< Walk on first.
  bool is_tight = false;   ///< Turn with the shortest steps.
};

/// Maximum turn of a step of the clip, played in steps of the engine.
[[nodiscard]] double max_turn_of(const SteerScene& scene, double alone_clip_s);

/// Returns the vector turned by an angle about Y.
[[nodiscard]] glm::dvec2 turned(glm::dvec2 xz_m, double angle_rad);

/// Returns the moment of the step that lands at `land_clip_s`, a time after `clip_s`; for
/// a step that has not begun, with an assumed pivot and the turns that its time permits.
[[nodiscard]] SteerMoment moment_of(const SteerScene& scene,
                                    const RootPlace& root,
                                    double clip_s,
                                    double land_clip_s,
                                    std::size_t step);

/// Step of a clip and the time of its landing.
struct NextLanding {
  std::size_t step = 0;
  double clip_s = 0.0;
};
/// Returns the first landing after a time of the clip.
[[nodiscard]] NextLanding next_landing(const ClipTravel& travel, double clip_s);
/// Returns the landing nearest to a time of the clip.
[[nodiscard]] NextLanding nearest_landing(const ClipTravel& travel, double clip_s);

/// Returns the displacement across (x) and along (z) the travel of the `further` steps
/// after a step. [legs]
[[nodiscard]] glm::dvec2 sum_of_steps(const ClipTravel& travel,
                                      std::size_t step,
                                      int further);
/// Returns the mean displacement of a step along the travel; > 0. [m]
[[nodiscard]] double mean_along_m(const SteerScene& scene);

/// Chooses turn and shift of one step.
[[nodiscard]] SteerMove choose_move(const SteerScene& scene,
                                    const SteerMoment& moment,
                                    const SteerStrategy& strategy);

/// True if a root at this place has arrived: within kNear_m of the goal, or, if the
/// course has `not_begun`, within half a step; and the next step (`moment`) would not
/// lead closer.
[[nodiscard]] bool is_arrival(const SteerScene& scene,
                              glm::dvec2 root_xz_m,
                              const SteerMoment& moment,
                              bool not_begun);

}  // namespace marey::engine
