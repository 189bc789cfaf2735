// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include "engine/models/ask_reach.h"
#include "engine/models/ball_flight.h"
#include "engine/models/throw_course.h"
#include "engine/step/blend_player.h"
#include "engine/step/rehearsal.h"
#include <glm/vec3.hpp>

#include "core/base/result.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/adapt/adapter.h"
#include "retarget/body/body_map.h"

namespace marey::engine {

/// A request to throw a ball: an action whose clip has the event at which the ball leaves
/// the hand. Parameters that `asked` does not name keep the values that they have in the
/// clip on this body.
struct ThrowWish {
  ActionWish action;
  int side = 1;  ///< 0: left hand, 1: right hand.
  std::string release = "release";
  ThrowChanges asked;
  /// The ball meets this point at the asked or captured speed; may move with
  /// Engine::aim() until two steps before the release. nullopt: the asked direction.
  std::optional<glm::dvec3> aim_in_world{};
  BallArc arc = BallArc::kFlat;
  BallOptions ball;
  /// Centre of the ball from the wrist, in the T-pose's axes [m]; nullopt: the palm.
  std::optional<glm::dvec3> ball_in_hand_m{};
  double half_width_s = 0.35;  ///< Around the release the wrist may leave the clip's way.
};

/// Answer about a throw, from lengths, without playing it.
struct ThrowFeasibility {
  bool reachable = false;
  double missing_m =
      0.0;  ///< Distance of the wrist's place from the places within reach.
  double duration_s = 0.0;   ///< Until the release, if it is played now.
  int steps = 0;             ///< The same in steps of the engine.
  bool aim_in_range = true;  ///< The ball can meet the aim.
  ThrowParameters captured;
  ThrowParameters wanted;
};

/// A throw as the body made it.
struct ThrowResult {
  /// Measured from the posed body at the instant of the release.
  ThrowParameters measured;
  ThrowParameters wanted;
  BallRelease ball;  ///< From the posed body; its time is the engine's.
  /// Distance at which the ball passes the aim at the predicted time of its arrival.
  std::optional<double> aim_miss_m{};
};

/// The body in a step of a throw.
struct ThrowStage {
  double time_s = 0.0;
  double step_s = 0.0;
  BlendPlayer& blend;
  std::span<const RigidTransform> reference;  ///< Joints of the blend at time_s.
  BodyShift shift;                            ///< After the last step.
  retarget::Adapter& adapter;
  std::span<std::optional<retarget::Adapter::Handle>> supports;
  retarget::Adapter::Handle point;
  retarget::Adapter::Handle turn;
};

/// Leads a hand of a character through a throw. The wrist's way is that of the blend,
/// displaced about the release. Before the release the posture at its instant is
/// rehearsed in each step, so that the wrist is placed against the hips as adapted.
/// Cost: up to three postures and one adaptation in a step. Allocates nothing in a step.
class ThrowPlayer {
 public:
  /// Errors (bad input): check_throw()'s; the clip has no such event; an aim, a lever, a
  /// ball option or a width that is not finite; both an aim and a direction; an instant
  /// that the rate of the clip cannot meet. `skeleton` and `map` must outlive it.
  [[nodiscard]] static Result<ThrowPlayer> make(const MotionBase& base,
                                                const Action& action,
                                                const ThrowWish& wish,
                                                const Skeleton& skeleton,
                                                const retarget::BodyMap& map);

  [[nodiscard]] ActionId action() const { return action_; }
  [[nodiscard]] int side() const { return wish_.side; }
  /// Moves the aim. Errors: the throw has no aim; not finite; the ball has left.
  [[nodiscard]] Status aim(const glm::dvec3& p_in_world);

  [[nodiscard]] ThrowFeasibility ask(const RootPlace& root,
                                     const Action& action,
                                     double step_s) const;

  /// Moves the constraints of the hand, and measures the release. No effect once it is
  /// over.
  void step(const ThrowStage& stage);

  [[nodiscard]] const ThrowParameters& captured() const { return captured_; }
  [[nodiscard]] const ThrowParameters& wanted() const { return course_.wanted(); }
  /// nullopt: the ball is in the hand.
  [[nodiscard]] const std::optional<ThrowResult>& result() const { return result_; }
  /// True from a quarter of a second before the release to the step after it: nothing but
  /// the clip and the hand's own way may move the hand then.
  [[nodiscard]] bool is_releasing(double time_s, double step_s) const {
    constexpr double kBefore_s = 0.25;
    return phase_ == Phase::kRunning && release_s_ > 0.0 &&
           time_s >= release_s_ - kBefore_s && time_s <= release_s_ + 2.0 * step_s;
  }
  /// True while it moves the constraints of its hand.
  [[nodiscard]] bool holds() const { return holds_; }
  [[nodiscard]] bool is_over() const { return phase_ == Phase::kOver; }
  /// Ends the constraints, for another model of this hand.
  void drop(double time_s,
            retarget::Adapter::Handle point,
            retarget::Adapter::Handle turn);

 private:
  enum class Phase { kWaiting, kRunning, kOver };
  ThrowPlayer(const Skeleton& skeleton, const retarget::BodyMap& map);
  void measure_captured(const MotionClip& clip, const PostureLayout& layout);
  void begin(const Action& action);
  void keep_instant(const ThrowStage& stage, const Action& action, PhaseWarp& warp);
  [[nodiscard]] bool forecast(const ThrowStage& stage, ThrowInstant& out);
  void follow_aim(const ThrowInstant& at_release);
  void rehearse(const ThrowStage& stage, const ThrowInstant& at_release);
  void measure(const ThrowStage& stage);
  void hold_hand(const ThrowStage& stage);
  void set_hand(const ThrowStage& stage,
                const glm::dvec3& wrist_in_world,
                const glm::dquat& world_from_hand) const;
  [[nodiscard]] glm::dvec3 carried(double time_s) const;

  const Skeleton* skeleton_;
  const retarget::BodyMap* map_;
  ActionId action_{};
  ThrowWish wish_;
  double event_s_ = 0.0;  ///< For the release, in the clip.
  ReachLengths lengths_;
  glm::dvec3 palm_in_t_pose_{0.0};
  glm::dvec3 lever_m_{0.0};
  ThrowParameters captured_;
  RootPlace captured_root_;  ///< At the release, from the start of the clip.
  RigidTransform captured_wrist_;
  glm::dvec3 captured_shoulder_{0.0};
  glm::dvec3 captured_hips_{0.0};
  ThrowCourse course_;
  Phase phase_ = Phase::kWaiting;
  double start_s_ = 0.0;    ///< Engine's time at which the clip's start would play.
  double release_s_ = 0.0;  ///< Engine's time of the release.
  double begin_s_ = 0.0;    ///< When the constraints start.
  double rate_ = 1.0;       ///< For the action.
  int replans_ = 0;
  bool holds_ = false;        ///< The constraints are active.
  bool aim_in_range_ = true;  ///< The last aim can be met.
  double aim_time_s_ = 0.0;   ///< Flight to the aim.
  glm::dvec3 carries_from_m_{0.0};
  glm::dvec3 carries_to_m_{0.0};
  RootPlace hips_from_blend_;  ///< At the release, by the posed body, in the world.
  std::optional<ThrowResult> result_;
  Rehearsal rehearsal_;
};

}  // namespace marey::engine
