// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/frame_range.h"
#include "core/base/time.h"
#include "core/human/contacts.h"
#include "retarget/body/body_map.h"
#include "retarget/feet/foot_place.h"

namespace marey::retarget {

/// The place of a standing foot on the floor Y = 0, in one frame.
struct Footprint {
  glm::dquat heading{1.0, 0.0, 0.0, 0.0};  ///< A turn about Y.
  glm::dvec3 ankle_in_world{0.0};          ///< [m]
  glm::dvec3 ball_in_world{0.0};           ///< Ball of the flat foot. [m]
};

/// Maximum angle between a footprint's yaw and the foot's own, by the part that bears.
/// [rad]
struct FootprintOptions {
  /// Heel and ball bear: 6.6 degrees. Chosen by measurement against 4 degrees (0.07) on
  /// synthetic and captured bodies (docs/accuracy/README.md): smaller values follow the
  /// noise of feet that do not turn, and their ankles drift.
  double flat_rad = 0.115;
  /// The ball bears alone: 15 degrees. Set by hand, not measured: toes on the floor turn
  /// less than a foot that rises on its ball.
  double ball_rad = 0.26;
  /// The heel bears alone: 46 degrees. Set by hand, not measured: the footprint then
  /// turns neither foot nor toes, so a wide limit costs nothing.
  double heel_rad = 0.8;
};

/// One foot's reference posture and the contacts of its heel and ball, frame by frame.
struct StandingFootPath {
  std::span<const FootPlace> reference;
  std::span<const char> heel;
  std::span<const char> ball;
};

/// Returns the footprint of a stance, one per frame of `run`.
///
/// A foot that keeps its yaw has one footprint: the mean of its flat positions. A foot
/// that turns while it stands has a footprint that turns with it, within the options' yaw
/// of the foot in each frame, about one point of the foot: the ball while the ball alone
/// bears, the ankle while the heel alone does, else the point between the two that moves
/// least, or the ball if the difference is small. A foot steeper than 70 degrees has no
/// yaw; it is interpolated. Cost: linear in frames.
/// Precondition: `run` lies within the path; all three spans have the same length.
[[nodiscard]] std::vector<Footprint> footprints(const StandingFootPath& path,
                                                const FrameRange& run,
                                                const FootMap& foot,
                                                FrameRate rate,
                                                const FootprintOptions& options = {});

}  // namespace marey::retarget
