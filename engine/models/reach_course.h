// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "engine/models/hand_motion.h"
#include "engine/models/quintic_leg.h"
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/result.h"

namespace marey::engine {

/// Target of a reach at an instant. Everything may change from step to step.
struct ReachTarget {
  glm::dvec3 p_in_world{0.0};  ///< For the point of the hand that reaches (the palm).
  glm::dvec3 velocity_m_s{0.0};
  /// Direction in which the hand moves when it arrives, relative to the target; not zero,
  /// any length. nullopt: that of the clip's hand, if `speed_m_s` asks for a speed.
  std::optional<glm::dvec3> approach;
  /// Speed of the hand relative to the target when it arrives. nullopt: 0, or
  /// ReachOptions::approach_speed_m_s with an approach direction.
  std::optional<double> speed_m_s;
  /// Rotation of the hand from the T-pose when it arrives. nullopt: that of the clip.
  std::optional<glm::dquat> world_from_hand;
  glm::dvec3 turn_rad_s{0.0};  ///< Angular velocity of that rotation, in world axes.
};

/// Refuses a target that cannot be asked for. Errors (bad input, naming the value): a
/// number that is not finite, a zero approach direction or rotation, a negative speed.
[[nodiscard]] Status check_target(const ReachTarget& target);

/// The points that a hand can reach: a ball. ask_reach() computes its radius.
struct ReachBall {
  glm::dvec3 centre_in_world{0.0};
  double radius_m = 0.0;
};

enum class AfterArrival {
  kHold,    ///< The hand moves with the target, until ReachCourse::release().
  kReturn,  ///< The displacement fades out; the clip's own hand returns.
};

struct ReachOptions {
  AfterArrival after = AfterArrival::kHold;
  /// Arrival is put off until the displacement can do with this. [m/s^2]
  double max_acceleration_m_s2 = 25.0;
  double max_turn_acceleration_rad_s2 = 150.0;
  double approach_speed_m_s = 0.1;  ///< See ReachTarget::speed_m_s.
  double trust_s = 0.3;             ///< A target's velocity counts for about this time.
  double settle_s = 0.2;  ///< Minimum time in which the hand stops at the target.
  double return_s = 0.4;  ///< Minimum time in which the displacement fades out.
};

/// Input of one step. "The clip's hand" is the reaching point of the hand in the posture
/// that is played, on this body, without the reach. Its place must be continuous with two
/// derivatives, as the way of the hand is then.
struct ReachInput {
  double time_s = 0.0;  ///< Of the posture that is made in this step.
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
  bool has_arrived = false;  ///< The hand has been within 1 mm of its target.
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
  /// one stays, and its velocity decays. Cost: about a microsecond.
  /// Precondition: started; times ascend by at most a few steps.
  ReachOutput step(const ReachInput& input);

  /// Ends holding: the hand returns to the clip's.
  void release();

 private:
  [[nodiscard]] ReachTarget current_target(const ReachInput& input, ReachOutput& output);
  void reach(const ReachInput& input, const ReachTarget& target, ReachOutput& output);
  void arrive(const ReachInput& input, const ReachTarget& target);
  void hold(const ReachInput& input, const ReachTarget& target, ReachOutput& output);
  void plan_return(double time_s, const Motion3& displacement, const Motion3& turn);

  ReachOptions options_;
  ReachPhase phase_ = ReachPhase::kDone;
  double time_s_ = 0.0;
  // Displacement and turn: of the clip's hand, or of the target while holding.
  Motion3 moved_;
  Motion3 turned_;
  QuinticLeg move_leg_;
  QuinticLeg turn_leg_;
  bool has_plan_ = false;
  bool has_arrived_ = false;
  bool has_target_ = false;
  bool released_ = false;
  double lost_s_ = 0.0;
  ReachTarget target_;  // At time_s_.
};

}  // namespace marey::engine
