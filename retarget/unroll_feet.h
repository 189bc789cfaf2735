// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "core/transform.h"
#include "retarget/body_map.h"
#include "retarget/normalized_skeleton.h"

namespace marey::retarget {

/// In how many frames a foot was found upside down against its shin, and the first.
struct RolledFeet {
  std::array<int, 2> frames{};  ///< Left, right.
  std::array<int, 2> first_frame{-1, -1};
};

/// Turns feet the right way up whose joint in the source is rolled by half a turn about
/// the foot's length: angles of captured ankles flip so, and stay flipped. No ankle bends
/// as far, and neither the knee nor the ankle's place shows it.
class FootUnroller {
 public:
  /// `pose` is `source`'s posture, normalized; its feet and toes are turned. A foot counts
  /// as rolled once its sole's upward direction is more than 107 degrees from the shin's,
  /// until it is less than 73 from it. No allocation.
  /// Precondition: `world_from_joint` are the joints' frames that it was made from.
  void step(const BodyMap& source,
            std::span<const RigidTransform> world_from_joint,
            NormalizedPose& pose);
  [[nodiscard]] const RolledFeet& found() const { return found_; }

 private:
  int frame_ = 0;
  std::array<bool, 2> is_rolled_{};
  RolledFeet found_;
};

}  // namespace marey::retarget
