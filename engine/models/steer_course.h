// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "engine/clips/sample_clip.h"
#include "engine/models/clip_travel.h"
#include "engine/models/steer_moves.h"
#include "engine/models/steer_settings.h"
#include "engine/models/swing_curve.h"

#include "core/base/result.h"
#include "core/engine/motion_clip.h"

namespace marey::engine {

/// State of a character in a step. Places on the floor are (x, z) in the world. [m]
struct SteerInput {
  double time_s = 0.0;  ///< Ascends from step to step.
  double step_s = 1.0 / 60.0;
  /// The root of this step: moved by the clip since the last step (whose root had been
  /// steered), not yet steered itself.
  RootPlace root{};
  double clip_s = 0.0;                    ///< Time in the clip; wrapped or not.
  double rate = 1.0;                      ///< Clip seconds per second: > 0.
  std::array<glm::dvec2, 2> foot_xz_m{};  ///< Ankles; left, right.
  std::array<bool, 2> bears{};
  /// Time until a bearing foot lifts off, or another one lands. [s]
  std::array<double, 2> until_edge_s{};
  double leg_length_m = 1.0;
};

enum class SteerState {
  kUnderWay,
  kArrived,    ///< Stays so until another goal is set.
  kOutOfTime,  ///< Not arrived SteerSettings::max_duration_s after the goal was set.
};

/// Changes of this step. Apply them by steered().
struct SteerStep {
  /// Turn about `pivot_xz_m`, the foot that stands alone. 0 while both feet bear or none
  /// does.
  double turn_rad = 0.0;
  glm::dvec2 pivot_xz_m{0.0};
  /// Displacement of the root, and with it of the swinging foot. [m]
  glm::dvec2 shift_xz_m{0.0};
  double scale = 1.0;  ///< Length of this step relative to the clip's.
  SteerState state = SteerState::kUnderWay;
  bool arrived = false;     ///< state == kArrived.
  int steps_left = 0;       ///< Landings until arrival, this step's included; 0: arrived.
  double distance_m = 0.0;  ///< From the steered root to the goal.
  /// Twist that each leg takes: the turn about this foot since it landed. At most
  /// SteerSettings::max_turn_rad; 0 for a swinging foot.
  std::array<double, 2> twist_rad{};
};

/// Leads a clip with a succession of supports to a goal on the floor (figure 7.8).
///
/// While one foot stands alone the course is turned about that foot, once per step, so
/// that the last step ends on the goal: the turn rises as a quintic (C2). The last steps
/// are longer or shorter. Travel direction: ClipTravel.
///
/// Quantities that turn: the root's place and heading turn (turn_about()), therefore all
/// that is sampled in the heading frame: hips, trunk, arms, the swinging foot and all
/// later footprints. The standing foot does not turn: the place and the orientation that
/// it had in the world when it landed are held by its support. Its leg takes the
/// difference between hips and foot: SteerStep::twist_rad, at most
/// SteerSettings::max_turn_rad over one stance (35 degrees; the hip takes it), and
/// returns to the clip's posture when the foot swings again. The shift moves the root
/// against the standing foot by at most 0.3 of the step; the leg's extension takes it.
///
/// Every step is planned at its first moment and replanned when the goal changes, if at
/// least SteerSettings::keep_s of the turn is left; otherwise the next step is the first
/// one that follows the new goal. Pure state: same inputs, same bytes; no function
/// allocates. Cost: a plan at the start of each swing, as ask_steer(); little otherwise.
class SteerCourse {
 public:
  /// Begins a course without a goal. `clip` and `travel` (travel_of_clip() of it) must
  /// outlive the course. Errors (bad input): SteerSettings out of range.
  [[nodiscard]] Status start(const MotionClip& clip,
                             const ClipTravel& travel,
                             const SteerSettings& settings = {});

  /// Sets or changes the goal, between two steps; the time that a course may last begins
  /// again if the goal changes. Error (bad input): not finite; the old goal stays.
  [[nodiscard]] Status aim(glm::dvec2 goal_xz_m);

  /// Returns the changes of one step. Without a goal there are none.
  /// Precondition: started; finite input; step, rate and leg length > 0.
  [[nodiscard]] SteerStep step(const SteerInput& now);

  [[nodiscard]] const SteerSettings& settings() const { return settings_; }

 private:
  /// A step from the moment at which a foot stands alone to the next landing.
  struct Swing {
    bool is_active = false;
    std::size_t stands = 0;  ///< Foot: 0 left, 1 right.
    double alone_end_s = 0.0;
    double land_s = 0.0;
    SwingCurve turn_rad;
    SwingCurve shift_x_m, shift_z_m;  ///< In the frame at the start, which turns.
    double turned_rad = 0.0;          ///< Until the last step.
    glm::dvec2 shifted_m{0.0};
    bool is_last = false;
  };

  void note_landings(const SteerInput& now);
  void begin_swing(const SteerInput& now);
  void move_along_swing(const SteerInput& now, SteerStep& out);
  void plan_swing(const SteerInput& now, const RootPlace& root);
  void keep_up_with_edges(const SteerInput& now);
  void shorten_turn(const SteerInput& now);
  [[nodiscard]] bool has_arrived(const SteerInput& now, bool not_begun) const;
  [[nodiscard]] SteerScene scene_of(const SteerInput& now) const;

  const MotionClip* clip_ = nullptr;
  const ClipTravel* travel_ = nullptr;
  SteerSettings settings_;
  SteerState state_ = SteerState::kUnderWay;
  bool has_goal_ = false;
  bool is_goal_new_ = false;
  glm::dvec2 goal_xz_m_{0.0};
  double end_s_ = 0.0;  ///< Time at which the course gives up.
  Swing swing_;
  bool has_landed_ = false;  ///< In this step.
  int steps_left_ = 0;
  double scale_ = 1.0;
  std::array<bool, 2> bore_{};
  std::array<double, 2> twist_rad_{};
};

/// Returns the root turned about a place on the floor: its place and its heading.
[[nodiscard]] RootPlace turn_about(const RootPlace& root,
                                   glm::dvec2 pivot_xz_m,
                                   double turn_rad);

/// Returns the root of a step after turn and shift.
[[nodiscard]] RootPlace steered(const RootPlace& root, const SteerStep& step);

}  // namespace marey::engine
