// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/clips/rig.h"
#include "engine/models/reach_course.h"
#include <glm/vec3.hpp>

#include "retarget/body/body_map.h"

namespace marey::engine {

/// Lengths of a body that limit the reach of one hand.
struct ReachLengths {
  double upper_arm_m = 0.0;
  double forearm_m = 0.0;
  double palm_m = 0.0;   ///< From the wrist to the point that reaches.
  double trunk_m = 0.0;  ///< From the hips joint to the shoulder joint.
  double leg_m = 0.0;
};

/// Returns the lengths for the left (0) or right (1) hand. The palm is the middle between
/// wrist and fingertip if `skeleton` has a tip, else 0.35 forearms from the wrist.
/// Precondition: `map` was made from `skeleton` and has this arm.
[[nodiscard]] ReachLengths reach_lengths(const Skeleton& skeleton,
                                         const retarget::BodyMap& map,
                                         int side);

/// Share of root and trunk in a reach: the part that the adapter may add to the clip.
struct ReachShare {
  double lean_rad = 0.35;        ///< Trunk, about the hips, in any direction.
  double step_legs = 0.05;       ///< Hips, in any direction. [legs]
  double max_extension = 0.999;  ///< For the arm.
  /// Angle of the elbow that is bent furthest; 0 would be the forearm on the upper arm.
  double min_elbow_rad = 0.6;
};

/// Question about a reach: places at the arrival of the clip, on this body.
struct ReachQuestion {
  glm::dvec3 hips_in_world{0.0};
  glm::dvec3 shoulder_in_world{0.0};
  HandMotion clip_at_arrival;  ///< As ReachInput.
  double clip_remaining_s = 0.0;
  ReachTarget target;
};

struct ReachFeasibility {
  bool reachable = false;
  double missing_m = 0.0;   ///< Distance of the target from the places within reach.
  double duration_s = 0.0;  ///< Until arrival; later than the clip's for a far target.
  int steps = 0;            ///< The same in steps of the engine; set by Engine::ask().
};

/// Answers whether a reach can succeed, from lengths, without playing it. The places
/// within reach are a shell about the shoulder, which the trunk leans and the hips move
/// towards the target. Cost: below 2 microseconds; no allocation.
/// Precondition: check_target() accepts the target.
[[nodiscard]] ReachFeasibility ask_reach(const ReachLengths& lengths,
                                         const ReachShare& share,
                                         const ReachQuestion& question,
                                         const ReachOptions& options = {});

/// Returns a ball about the shoulder for ReachInput::within: the arm alone plus the same
/// shares towards the place `towards_in_world`.
[[nodiscard]] ReachBall reach_ball(const ReachLengths& lengths,
                                   const ReachShare& share,
                                   const glm::dvec3& hips_in_world,
                                   const glm::dvec3& shoulder_in_world,
                                   const glm::dvec3& towards_in_world);

}  // namespace marey::engine
