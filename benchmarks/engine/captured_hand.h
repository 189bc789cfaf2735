// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "engine/clips/sample_clip.h"
#include "engine/models/hand_motion.h"

#include "core/humanoid.h"
#include "core/pose.h"
#include "core/signal/cubic_spline.h"
#include "core/skeleton.h"

namespace marey {

/// A captured hand: the wrist of a clip's own skeleton, with two continuous derivatives
/// (cubic splines through its places), and the place of the hips.
class CapturedHand {
 public:
  /// Precondition: at least 5 poses; the skeleton has the bone and hips.
  CapturedHand(const Skeleton& skeleton,
               const std::vector<Pose>& poses,
               double rate_hz,
               HumanBone hand);

  [[nodiscard]] double duration_s() const;
  /// Precondition: within the clip, two frames from its ends.
  [[nodiscard]] engine::HandMotion at(double time_s) const;
  [[nodiscard]] engine::RootPlace root(double time_s) const;

 private:
  [[nodiscard]] glm::dquat rotation(double time_s) const;

  double rate_hz_ = 0.0;
  std::vector<glm::dquat> rotations_;
  std::vector<CubicSpline> place_;  // x, y, z of the wrist.
  std::vector<CubicSpline> root_;   // x, z and heading of the hips.
};

}  // namespace marey
