// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/base/frame_range.h"
#include "core/base/time.h"
#include "core/floor.h"
#include "core/human/contacts.h"
#include "retarget/body/body_map.h"
#include "retarget/feet/plan_foot_path.h"

namespace marey::retarget {

/// A stance, or a section of one, and the floor part that it stands on.
struct FloorStance {
  FrameRange frames;
  FloorPartIndex part;
};

/// One foot on a floor, frame by frame.
struct FloorFoot {
  std::vector<FootPlace> places;
  /// Displacement of the foot by the floor, without the lift over edges. [m]
  std::vector<glm::dvec3> carried_m;
  std::vector<FloorStance> stances;  ///< In the order of the contacts' stances.
};

struct StandFeetOptions {
  /// Maximum rotation of a foot with the floor: about as far as a standing ankle bends.
  /// On steeper ground only the foot's deciding point (ankle or ball) is in contact.
  /// [rad]
  double max_foot_pitch_rad = 0.6;
};

/// Puts feet that were planned on the level floor Y = 0 (plan_foot_path()) on another
/// floor.
///
/// Each stance stands, as a rigid whole, on the plane of one part: the part under its
/// ankle when it begins; in stances on the ball alone, the part under the ball. So a foot
/// that straddles an edge is on the side of its ankle, its toes over or within the other
/// side, and a foot that rolls does not change parts. The footprint keeps its place in X
/// and Z; its ankle keeps its height above the ground; the foot is turned by the smallest
/// rotation from Y to the normal.
///
/// A foot on a moving part is carried along while it stands, and so are the next
/// footprints: each by the mean displacement, along X and Z, of the feet that stood
/// before it.
///
/// Between two stances the foot moves from one displacement to the other with continuous
/// speed and acceleration. The transition begins when the foot leaves, and follows moving
/// parts on both sides. The foot is lifted over obstacles (ankle and ball, with a
/// clearance of kClearanceInLegs) by one bump per swing: by at most kMaxLiftInLegs, and
/// not for obstacles where the bump is below kLateLift. It passes through those. Before
/// the first stance and after the last it keeps that stance's displacement; a foot that
/// never stands has the base's. On a level floor at 0 nothing changes, to the bit. Cost:
/// frames times parts.
/// Precondition: `flat` and `contacts` have the same frames; frame i is at (first_frame +
/// i) / rate seconds.
[[nodiscard]] std::array<FloorFoot, 2> stand_feet_on(
    const Floor& floor,
    const std::array<std::vector<FootPlace>, 2>& flat,
    const Contacts& contacts,
    const BodyMap& map,
    FrameRate rate,
    int first_frame,
    const StandFeetOptions& options = {});

/// Clearance of a lifted swinging foot above an edge, in leg lengths: room for the toes
/// in front of the ball.
inline constexpr double kClearanceInLegs = 0.025;
/// Maximum lift, in leg lengths: a knee that bends by 120 degrees.
inline constexpr double kMaxLiftInLegs = 0.5;
/// Minimum share of the bump's height at which an obstacle is still lifted over. Nearer
/// to a stance the whole swing would rise by more than three times the edge.
inline constexpr double kLateLift = 0.3;

}  // namespace marey::retarget
