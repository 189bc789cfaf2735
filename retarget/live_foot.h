// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "retarget/body_map.h"
#include "retarget/foot_plan.h"
#include "retarget/live_retarget.h"

namespace marey::retarget {

/// One joint of a foot, posture after posture: how fast it is, and whether it rests, by
/// speed and height with hysteresis in both. Lengths in leg lengths of the source.
class LiveContact {
 public:
  void forget() { *this = LiveContact(); }
  /// Its next place; 0 of the first.
  double speed_legs_per_s(const glm::dvec3& p_legs,
                          double since_last_s,
                          const LiveRetargetOptions& options);
  /// `height_legs` is above where it rests.
  bool rests(double height_legs, const LiveRetargetOptions& options);

 private:
  bool is_known_ = false;
  bool rests_ = false;
  glm::dvec3 before_legs_{0.0};
  glm::dvec3 velocity_legs_per_s_{0.0};
};

/// Learns how much higher than its rest pose's floor a foot stands: bodies that were
/// fitted to markers stand some centimetres off it.
class LiveFloor {
 public:
  void forget() { offset_legs_ = 0.0; }
  /// `height_legs` is that of the foot's lower joint above where it should rest, which a
  /// heel that is up with its ball down does not raise.
  void look(double height_legs,
            double speed_legs_per_s,
            double since_last_s,
            const LiveRetargetOptions& options);
  [[nodiscard]] double offset_legs() const { return offset_legs_; }

 private:
  double offset_legs_ = 0.0;
};

/// Keeps one foot of the avatar where it stands, and lets it go again.
class LiveFoot {
 public:
  void forget() { *this = LiveFoot(); }
  /// `place` is where the foot would be without; it becomes where it is to be.
  void hold(const StandingFoot& stands,
            const FootMap& foot,
            double leg_length_m,
            double since_last_s,
            const LiveRetargetOptions& options,
            FootPlace& place);

 private:
  enum class Mode { kFree, kFlat, kHeel, kBall };
  static Mode mode_of(const StandingFoot& stands);

  void begin(Mode mode, const FootMap& foot, const FootPlace& reference);
  [[nodiscard]] FootPlace aim(const FootMap& foot, const FootPlace& reference) const;

  bool is_known_ = false;
  Mode mode_ = Mode::kFree;
  double since_change_s_ = 0.0;
  FootPlace last_;           // As delivered,
  FootPlace last_reference_;  // and as it would have been.
  glm::dvec3 anchor_in_world_{0.0};  // Of the joint that bears, at its resting height.
  glm::dquat heading_{1.0, 0.0, 0.0, 0.0};
  // What fades since the last change: of the bearing joint, or of the ankle when none
  // bears, and of the turns (world axes, on top of the aim's).
  glm::dvec3 left_over_m_{0.0};
  glm::dvec3 foot_left_over_rad_{0.0};
  glm::dvec3 toes_left_over_rad_{0.0};
};

}  // namespace marey::retarget
