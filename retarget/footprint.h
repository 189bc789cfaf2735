// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/time.h"
#include "retarget/body_map.h"
#include "retarget/detect_contacts.h"
#include "retarget/foot_plan.h"

namespace marey::retarget {

/// The place of a standing foot on the floor Y = 0, in one frame.
struct Footprint {
  glm::dquat heading{1.0, 0.0, 0.0, 0.0};  ///< A turn about Y.
  glm::dvec3 ankle_in_world{0.0};          ///< [m]
  glm::dvec3 ball_in_world{0.0};           ///< Of the flat foot. [m]
};

/// How far a footprint's yaw may be from the foot's own, by what bears. [rad]
struct FootprintOptions {
  double flat_rad = 0.115;
  /// Toes on the floor turn less than a foot that rises on its ball.
  double ball_rad = 0.26;
  double heel_rad = 0.8;  ///< Nothing is turned by the footprint then.
};

/// One foot's posture to keep, and when its heel and its ball bear, frame by frame.
struct StandingFootPath {
  std::span<const FootPlace> reference;
  std::span<const char> heel;
  std::span<const char> ball;
};

/// Returns the footprint of a stance, one per frame of `run`.
///
/// A foot that keeps its yaw has one footprint: the mean of where it stands flat. A foot
/// that turns while it stands has a footprint that turns with it, within the options' yaw
/// of the foot in each frame, and about one point of the foot: the ball while the ball
/// alone bears, the ankle while the heel alone does, else the point between the two that
/// moves least, which is the ball in case of doubt. A foot steeper than 70 degrees has no
/// yaw; it is interpolated. Cost: linear in frames.
/// Precondition: `run` lies within the path; all three spans are as long.
[[nodiscard]] std::vector<Footprint> footprints(const StandingFootPath& path,
                                                const FrameInterval& run,
                                                const FootMap& foot,
                                                FrameRate rate,
                                                const FootprintOptions& options = {});

}  // namespace marey::retarget
