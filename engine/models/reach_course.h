// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "engine/models/hand_motion.h"
#include "engine/models/quintic_leg.h"
#include "engine/models/reach_plan.h"
#include "engine/models/reach_target.h"

namespace marey::engine {

/// Input of one step. "The clip's hand" is the reaching point of the hand in the posture
/// that is played, on this body, without the reach. Its place must be continuous with two
/// derivatives, as the way of the hand is then.
struct ReachInput {
  double time_s = 0.0;  ///< For the posture that is made in this step.
  double step_s = 0.0;  ///< To the next one; > 0.
  HandMotion clip_now;  ///< The clip's hand at time_s.
  /// The clip's hand when the event "arrive" of the clip is played, under the current
  /// prediction of the root.
  HandMotion clip_at_arrival;
  double arrive_s = 0.0;  ///< Time of that event at the current rate of the clip.
  /// Time to that event if the clip plays at rate 1. The arrival is put off to at most
  /// twice this time. 0 after it.
  double clip_remaining_s = 0.0;
  std::optional<ReachTarget> target;  ///< At time_s; nullopt: lost.
  std::optional<ReachBall> within;    ///< nullopt: the target is within reach.
};

enum class ReachPhase { kReaching, kHolding, kReturning, kDone };

/// Result of one step.
struct ReachOutput {
  HandMotion hand;     ///< The wanted hand at ReachInput::time_s, with its derivatives.
  bool turns = false;  ///< Its rotation differs from the clip's.
  ReachPhase phase = ReachPhase::kReaching;
  double remaining_s = 0.0;  ///< Until the hand arrives; 0 after that.
  /// Time of arrival: ReachInput::arrive_s, or later if that is too early for the
  /// displacement. The caller plays the clip so that its event happens then. If it does
  /// not, the hand arrives later than the clip.
  double arrive_s = 0.0;
  double rate = 1.0;         ///< Mean rate of the clip until then, at least 0.5.
  bool has_arrived = false;  ///< The hand has been within 3 mm of its target.
  bool target_lost = false;
  double missing_m = 0.0;  ///< Distance of the target from ReachInput::within.
};

/// The way of a hand to a target (Kulpa 2005, 7.2.1, figure 7.6): a displacement of the
/// clip's hand that is recomputed in each step, from its current state to the arrival at
/// the predicted place of the target, as a polynomial of degree five. So the way has two
/// continuous derivatives whatever the target does. The plan of the last two steps is
/// kept. Turning or moving the world turns or moves the way. No function allocates.
class ReachCourse {
 public:
  /// Begins at a time with the clip's hand, or with a hand that is shown elsewhere (by an
  /// earlier reach).
  void start(double time_s,
             const HandMotion& clip_now,
             const ReachOptions& options,
             const std::optional<HandMotion>& shown = std::nullopt);

  /// Computes the next step. A target with numbers that are not finite is lost: the last
  /// one stays, and its velocity decays. Cost: some microseconds.
  /// Precondition: started; times ascend by at most a few steps.
  ReachOutput step(const ReachInput& input);

  /// Ends holding: the hand returns to the clip's.
  void release();

 private:
  // The hand whose displacement is the state: the clip's, or the target while holding.
  [[nodiscard]] HandMotion held_base(const ReachInput& input) const;
  void follow_target(const ReachInput& input, ReachOutput& output);
  void wait(const ReachInput& input, ReachOutput& output);
  void reach(const ReachInput& input, ReachOutput& output);
  void arrive(const ReachInput& input, double event_s);
  void hold(const ReachInput& input, ReachOutput& output);
  void absorb_jump(const ReachInput& input, const HandMotion& base);
  void begin_return(double time_s, const Motion3& moved_m, const Motion3& turned_rad);
  void come_back(const ReachInput& input, ReachOutput& output);
  void advance_to(double time_s);

  ReachOptions options_;
  ReachPhase phase_ = ReachPhase::kDone;
  double time_s_ = 0.0;
  Motion3 moved_m_;  // At time_s_.
  Motion3 turned_rad_;
  ArrivalPlan plan_;
  bool has_plan_ = false;
  bool has_arrived_ = false;
  bool released_ = false;
  std::optional<ReachTarget> given_;  // The last usable target; moved on while lost.
  ReachTarget target_;                // Within reach, at the time of the step.
  ReachTarget last_target_;           // At time_s_.
};

}  // namespace marey::engine
