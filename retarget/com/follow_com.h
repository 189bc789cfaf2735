// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

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

struct FollowComReport {
  double worst_com_m = 0.0;  ///< Largest distance of the centre of mass from its target.
  int worst_com_frame = 0;
  double worst_foot_m = 0.0;  ///< Largest distance of a held foot from its place.
  int worst_foot_frame = 0;
  double worst_flight_com_m = 0.0;  ///< The same among frames in which no foot is held.
  double raised_heel_m = 0.0;  ///< Largest rise of an ankle by rotation about the ball.
  /// Largest length by which a leg was too short for its goal, heel raised. Then the
  /// centre of mass stays below its target.
  double short_leg_m = 0.0;
  int short_leg_frame = 0;
  int short_leg_frames = 0;
};

/// Moves the root of each reference posture so that the centre of mass is at its target
/// with the held feet at their places; legs follow analytically. Trunk, head and arms
/// keep their rotations, so most of a displacement bends nothing. Without a held foot the
/// result is exact (the whole body is displaced). With held feet: Newton steps on the
/// root's position until 1e-6 m. Where a leg is too short the heel rises about the ball
/// as far as `heel_may_rise` permits; what remains is reported. Displacements that this
/// adds between frames are smoothed (displacement map), so that jerk stays near the
/// reference's.
///
/// `out` has one pose per frame. A frame whose target and places are the reference's own
/// keeps its pose to the bit. Allocates nothing per frame; some microseconds per frame.
FollowComReport follow_com(const ComFollower& body,
                           const ComPlan& plan,
                           std::span<Pose> out);

}  // namespace marey::retarget
