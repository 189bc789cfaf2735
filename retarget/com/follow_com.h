// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/pose.h"
#include "retarget/com/com_plan.h"

namespace marey::retarget {

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
/// whole body is displaced, and the result is exact to rounding. With held feet: secant
/// steps on the root's position until 1e-9 m; reference legs that are exactly straight
/// may leave 1e-6 m. Each frame depends on its own entries only, and small changes of the
/// plan change the posture little.
///
/// A leg reaches up to 0.995 of its length, or as far as in the reference if that is
/// more. Before that the heel rises about the ball (without toe joints: about the sole's
/// front end) as far as `heel_may_rise` permits, gradually, while the toes stay flat.
/// The remaining error is reported, and the centre of mass stays as near to its target as
/// the legs permit. A partly held foot is between its place and the place that it has on
/// the displaced body; where it is too far it gives way instead of the root (from a hold
/// of 0.7 on they share).
///
/// `out` has one pose per frame and may be the reference's own poses. A frame whose
/// target and places are the reference's own (within 1e-12) keeps its pose to the bit.
/// Allocates nothing per frame if the poses of `out` have the number of joints already.
/// Costs two forward kinematics and about five evaluations of the legs per frame
/// (docs/accuracy/dynamics.md). Precondition: spans of the same length; `map` was made
/// from `skeleton`; the masses' sum is positive; unit rotations.
FollowComReport follow_com(const ComFollower& body,
                           const ComPlan& plan,
                           std::span<Pose> out);

}  // namespace marey::retarget
