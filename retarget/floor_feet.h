// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/floor.h"
#include "core/time.h"
#include "retarget/body_map.h"
#include "retarget/detect_contacts.h"
#include "retarget/foot_plan.h"

namespace marey::retarget {

/// A stance, or a part of one, and what it stands on.
struct FloorStance {
  FrameInterval frames;
  FloorPartIndex part;
};

/// One foot on a floor, frame by frame.
struct FloorFoot {
  std::vector<FootPlace> places;
  /// How far the floor displaces the foot, without what lifts it over edges. [m]
  std::vector<glm::dvec3> carried_m;
  std::vector<FloorStance> stances;  ///< As the contacts'.
};

struct FloorFeetOptions {
  /// A foot turns no further with the floor: about as far as a standing ankle bends.
  /// Steeper ground it touches with the point that decides alone. [rad]
  double steepest_foot_rad = 0.6;
};

/// Puts feet that were planned on the level floor Y = 0 (plan_foot()) on another floor.
///
/// Each stance stands, as a rigid whole, on the plane of one part: the one that is under
/// its ankle when it begins; in stances on the ball alone, under the ball. So a foot that
/// straddles an edge is on the side of its ankle, its toes over or within the other side,
/// and a foot that rolls does not change parts. The footprint keeps its place in X and Z,
/// its ankle its height above the ground; the foot is turned by the least rotation from Y
/// to the normal.
///
/// A foot on a moving part is carried along as long as it stands, and so is where the
/// next feet come down: each by the mean of what the floor carried the standing feet
/// until then, along X and Z.
///
/// Between two stances the foot goes over from one displacement to the other with
/// continuous speed and acceleration, beginning as it leaves, following moving parts on
/// both sides; and it is lifted over what would be in its way (ankle and ball, with
/// kClearanceInLegs to spare), by one bump a swing: by kMostLiftInLegs at most, and not
/// for what it meets where the bump is below kLateLift. Those it goes through. Before the
/// first stance and after the last it keeps that one's displacement; a foot that never
/// stands has the base's. On a level floor at 0 nothing changes, to the bit. Costs frames
/// times parts. Precondition: `flat` and `contacts` have the same frames; frame i is at
/// (first_frame + i) / rate seconds.
[[nodiscard]] std::array<FloorFoot, 2> stand_feet_on(
    const Floor& floor,
    const std::array<std::vector<FootPlace>, 2>& flat,
    const Contacts& contacts,
    const BodyMap& map,
    FrameRate rate,
    int first_frame,
    const FloorFeetOptions& options = {});

/// What a swinging foot that must be lifted keeps above an edge, in leg lengths: for the
/// toes in front of the ball.
inline constexpr double kClearanceInLegs = 0.025;
/// The highest that it is lifted, in leg lengths: a knee that bends by 120 degrees.
inline constexpr double kMostLiftInLegs = 0.5;
/// Nearer to a stance than where the bump has this share of its height, lifting comes too
/// late: it would throw the whole swing up by more than three times the edge.
inline constexpr double kLateLift = 0.3;

}  // namespace marey::retarget
