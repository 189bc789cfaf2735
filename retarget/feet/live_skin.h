// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "core/pose.h"
#include "core/skeleton.h"
#include "retarget/body/body_map.h"
#include "retarget/body/skin.h"
#include "retarget/feet/lift_skin.h"
#include "retarget/feet/live_stance.h"

namespace marey::retarget {

/// lift_skin() posture by posture: skin that is too low rises at once, as far as it must,
/// and comes down with a time constant. So the result is as continuous as the posture,
/// without using future postures.
class LiveSkinLift {
 public:
  LiveSkinLift() = default;
  /// `skin` belongs to the body that step() receives. The body comes down with the time
  /// constant `fall_s`, feet and hands with `limb_fall_s`.
  LiveSkinLift(Skin skin, double fall_s, double limb_fall_s);

  /// Raises `pose` out of the floor Y = 0, as far as it is deeper than `allowed_m`.
  /// `world_from_joint` are its joints, before and after. Allocates only in the first
  /// call.
  /// Precondition: `since_last_s` > 0.
  void step(const Skeleton& body,
            const BodyMap& map,
            const std::array<StandingFoot, 2>& standing,
            double allowed_m,
            double since_last_s,
            std::span<RigidTransform> world_from_joint,
            Pose& pose);
  void reset() { last_ = SkinLift{}; }

 private:
  Skin skin_;
  double fall_s_ = 0.3;
  double limb_fall_s_ = 0.08;
  std::vector<glm::dvec4> rows_;
  Pose scratch_;
  SkinLift last_;
};

}  // namespace marey::retarget
