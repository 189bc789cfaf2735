// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/models/ask_reach.h"
#include "engine/models/reach_course.h"
#include "engine/step/blend_player.h"

#include "core/base/result.h"
#include "core/constraint.h"
#include "core/pose.h"
#include "core/transform.h"
#include "retarget/adapt/adapter.h"
#include "retarget/body/body_map.h"
#include "retarget/body/normalized_pose.h"

namespace marey::engine {

/// A request to reach for a target with a hand: an action whose clip has the event at
/// which its hand arrives.
struct ReachWish {
  ActionWish action;
  int side = 1;  ///< 0: left hand, 1: right hand.
  std::string arrive = "arrive";
  ReachTarget target;
  ReachOptions options;
  ReachShare share;
  /// Further captured reaches: with that of `action` a family, of which those nearest to
  /// the target are blended (ReachFamily). All begin at their starts, without
  /// synchronisation.
  std::vector<std::string> family;
};

/// Returns the constraints by which the engine moves a hand: ids "reach left" and "reach
/// turn left", or of the right one. They act when a reach starts.
/// Precondition: `map` was made from `skeleton` and has this arm.
[[nodiscard]] std::array<Constraint, 2> reach_constraints(const Skeleton& skeleton,
                                                          const retarget::BodyMap& map,
                                                          int side);

/// Leads one hand of a character to a target while an action plays. The posture that it
/// displaces is the blend of all actions. Costs five expansions of a posture in a step.
class ReachPlayer {
 public:
  /// Errors (bad input): check_target()'s; the clip has no such event; a number of the
  /// options that is not finite.
  [[nodiscard]] static Result<ReachPlayer> make(const MotionBase& base,
                                                ActionId action,
                                                std::size_t clip,
                                                const ReachWish& wish,
                                                const Skeleton& skeleton,
                                                const retarget::BodyMap& map);

  [[nodiscard]] ActionId action() const { return action_; }
  [[nodiscard]] int side() const { return wish_.side; }
  /// Moves the target. Errors: check_target()'s; the old target stays.
  [[nodiscard]] Status aim(const ReachTarget& target);
  void release() { course_.release(); }
  /// Adds a reach of the family that plays along: its event is moved with that of the
  /// main one, and it stops with it. At most two.
  void add_companion(ActionId action, double event_s);

  /// Answers whether the reach can succeed if its action began now, from the root's
  /// present place, without other actions.
  [[nodiscard]] ReachFeasibility ask(const BlendPlayer& blend, const Action& action);

  /// Computes the hand of this step and moves the constraints; false: it is over, and the
  /// constraints are stopped. `world_from_joint` are joints of the blend on the body at
  /// time_s.
  bool step(double time_s,
            double step_s,
            BlendPlayer& blend,
            std::span<const RigidTransform> world_from_joint,
            double lift_m,
            retarget::Adapter::Handle point,
            retarget::Adapter::Handle turn);

  [[nodiscard]] const ReachOutput& last() const { return last_; }

 private:
  ReachPlayer(const Skeleton& skeleton, const retarget::BodyMap& map);
  [[nodiscard]] RigidTransform palm(
      std::span<const RigidTransform> world_from_joint) const;
  [[nodiscard]] RigidTransform predicted_palm(double now_s,
                                              double time_s,
                                              const BlendPlayer& blend);
  struct Companion {
    ActionId action{};
    double event_s = 0.0;
  };
  void put_off(double time_s, double step_s, double arrive_s, BlendPlayer& blend);

  const Skeleton* skeleton_;
  const retarget::BodyMap* map_;
  ActionId action_{};
  double event_s_ = 0.0;  ///< For arrival, in the clip.
  ReachWish wish_;
  ReachLengths lengths_;
  glm::dvec3 palm_in_t_pose_{0.0};
  ReachCourse course_;
  ReachOutput last_;
  bool has_started_ = false;
  std::array<Companion, 2> companions_{};
  std::size_t companion_count_ = 0;
  double lift_m_ = 0.0;
  RigidTransform palm_before_;
  retarget::NormalizedPose normalized_;
  std::vector<RigidTransform> joints_;
  Pose pose_;
};

}  // namespace marey::engine
