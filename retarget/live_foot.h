// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include "retarget/body_map.h"
#include "retarget/foot_plan.h"
#include "retarget/live_retarget.h"

namespace marey::retarget {

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
  /// Turns the flat foot about its ball until its yaw is the reference's to some degrees.
  void turn_along(const FootMap& foot, const FootPlace& reference);
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
