// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/transform.h"
#include "retarget/body/body_map.h"
#include "retarget/body/normalized_skeleton.h"

namespace marey::retarget {

/// Number of frames in which a foot is upside down against its shin, and the first one.
struct RolledFeet {
  std::array<int, 2> frames{};                      ///< Left, right.
  std::array<std::optional<int>, 2> first_frame{};  ///< nullopt: in no frame.
};

/// Turns feet the right way up if their joint in the source is rolled by half a turn
/// about the foot's length. Angles of captured ankles flip in this way, and stay flipped.
/// No ankle bends as far, and neither the knee nor the ankle's position shows the flip.
class FootUnroller {
 public:
  /// `pose` is `source`'s posture, normalized; its feet and toes are turned. A foot
  /// counts as rolled from the time its sole's upward direction is more than 107 degrees
  /// from the shin's until it is less than 73 degrees from it. Allocates nothing.
  /// Precondition: `world_from_joint` are the joint frames from which `pose` was made.
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
