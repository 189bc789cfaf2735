// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include <glm/vec3.hpp>

#include "core/base/time.h"
#include "core/character.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "retarget/body/body_map.h"
#include "retarget/feet/foot_place.h"

namespace marey::retarget {

/// Wanted place of one foot in one frame.
struct FootGoal {
  FootPlace place;    ///< T-pose-relative, as foot_places() of edit gives it.
  double hold = 0.0;  ///< 1: the foot is there. 0: it follows the body. Between: a fade.
  /// Share by which the heel may rise about the ball where the leg is too short: 1 while
  /// the foot pushes off.
  double heel_may_rise = 0.0;
  /// Share by which the root gives way where the leg is too short: 1 while the foot
  /// bears. 0: the centre of mass stays on its target, and the foot leaves its place.
  double root_gives_way = 1.0;
};

/// A body whose centre of mass follows a plan.
struct ComFollower {
  const Skeleton& skeleton;
  const BodyMap& map;
  std::span<const PointMass> masses;
  FrameRate rate;
};

/// Plan per frame; all spans have the same length.
struct ComPlan {
  std::span<const Pose> reference;                ///< Postures to follow.
  std::span<const glm::dvec3> com_in_world;       ///< Targets. [m]
  std::array<std::span<const FootGoal>, 2> feet;  ///< Left, right.
};

}  // namespace marey::retarget
