// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/constraint.h"
#include "core/floor.h"
#include "core/motion.h"
#include "retarget/body_map.h"
#include "retarget/detect_contacts.h"
#include "retarget/floor_feet.h"

namespace marey::retarget {

/// One way in which one foot bears over a motion: flat, on its heel or on its ball.
struct SupportTrack {
  /// A Support that does not begin by itself; its durations are the ramps. On the heel or
  /// the ball alone the foot may turn about that joint; where the flat foot takes over or
  /// is taken over from, with a frame in common, there is no ramp.
  Constraint constraint;
  /// When it bears, ascending, further apart than the ramps between them.
  std::vector<FrameInterval> bears;
  /// The runs of single stances, and which part of the floor each stands on.
  std::vector<FloorStance> stands;
  /// Where its point is to be, and how the foot is turned from the T-pose, frame by
  /// frame: still on its floor while the point bears, on the reference's own way
  /// elsewhere, so that what fades in or out does it beside a foot that moves.
  std::vector<glm::dvec3> p_in_world;
  std::vector<glm::dquat> world_from_t_pose;
  /// The ball, from the joint, as the constraint's offset is: a flat foot that turns while
  /// it stands turns about it or about the ankle.
  glm::dvec3 ball_in_t_pose{0.0};
};

struct PlanSupportsOptions {
  /// How long a support takes to fade in before its foot bears, and out after. [s]
  double ramp_s = 0.15;
  double floor_height_m = 0.0;           ///< World Y on which the reference stands.
  std::array<bool, 2> feet{true, true};  ///< Left, right: which are wanted.
  /// What to stand on instead, its heights from `floor_height_m`; null: that level floor.
  const Floor* floor = nullptr;
};

/// The supports of the feet of a motion (Kulpa 2005, 3.1.1.1 and 4.2.4), each stance with
/// one footprint: plan_feet()'s. On a floor that moves, footprints do, too. Heel and ball
/// have tracks for when they bear alone: the flat foot needs no other. Runs that are
/// nearer to each other than their ramps are one: between them the foot keeps to the
/// planned way, too. Points that never bear have no track. Costs frames times stances.
/// Precondition: `map` was made from the motion's skeleton; `contacts` has its frames.
[[nodiscard]] std::vector<SupportTrack> plan_supports(
    const Motion& reference,
    const BodyMap& map,
    const Contacts& contacts,
    const PlanSupportsOptions& options = {});

}  // namespace marey::retarget
