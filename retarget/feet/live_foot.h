// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "retarget/body/body_map.h"
#include "retarget/feet/foot_place.h"
#include "retarget/feet/live_stance.h"

namespace marey::retarget {

/// Timing and limits of a foot's transition onto a footprint and off it.
struct LiveFootOptions {
  double land_s = 0.08;     ///< Time in which a landing foot becomes flat.
  double release_s = 0.25;  ///< Time in which a leaving foot returns to its own path.
  /// A foot held further than this from the source's place slips. [legs]
  double slip_legs = 0.3;
};

/// Holds one foot of the avatar on its footprint while it stands, and releases it.
class LiveFoot {
 public:
  void reset() { *this = LiveFoot(); }
  /// `place`: in, the foot without the contact constraint; out, with it.
  /// Precondition: `since_last_s` is above 0.
  void hold(const StandingFoot& stands,
            const FootMap& foot,
            double leg_length_m,
            double since_last_s,
            const LiveFootOptions& options,
            FootPlace& place);

 private:
  enum class Mode { kFree, kFlat, kHeel, kBall };
  static Mode mode_of(const StandingFoot& stands);

  void begin(Mode mode, const FootMap& foot, const FootPlace& reference);
  /// Turns the flat foot about its ball until its yaw is within a few degrees of the
  /// reference's.
  void turn_along(const FootMap& foot, const FootPlace& reference);
  [[nodiscard]] FootPlace aim(const FootMap& foot, const FootPlace& reference) const;

  bool is_known_ = false;
  Mode mode_ = Mode::kFree;
  double since_change_s_ = 0.0;
  FootPlace last_;                   // Last result,
  FootPlace last_reference_;         // and without the contact constraint.
  glm::dvec3 anchor_in_world_{0.0};  // Place of the bearing joint at rest height.
  glm::dquat heading_{1.0, 0.0, 0.0, 0.0};
  // Fading offsets that remain from the last change of mode: the bearing joint's (the
  // ankle's when none bears), and the rotations' (world axes, applied after the aim's).
  glm::dvec3 left_over_m_{0.0};
  glm::dvec3 foot_left_over_rad_{0.0};
  glm::dvec3 toes_left_over_rad_{0.0};
};

}  // namespace marey::retarget
