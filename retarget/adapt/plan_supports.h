// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/frame_range.h"
#include "core/constraint.h"
#include "core/floor.h"
#include "core/human/contacts.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"
#include "retarget/feet/stand_feet_on.h"

namespace marey::retarget {

/// One contact type of one foot over a motion: flat, on the heel or on the ball.
struct SupportTrack {
  /// A Support that is not active by itself; its durations are the ramps. On the heel or
  /// the ball alone the foot may rotate about that joint. There is no ramp at a
  /// transition to or from the flat foot that shares a frame with it.
  Constraint constraint;
  /// Intervals of contact, ascending, separated by more than the ramps between them.
  std::vector<FrameRange> bears;
  /// Runs of frames of the single stances, and the floor part of each.
  std::vector<FloorStance> stands;
  /// Target position of the point and rotation of the foot from the T-pose, per frame.
  /// Fixed to its floor part during contact. At other frames it is on the reference's own
  /// path, so that fading constraints follow the moving foot.
  std::vector<glm::dvec3> p_in_world;
  std::vector<glm::dquat> world_from_t_pose;
  /// Ball of the foot relative to the joint, in the T-pose as the constraint's offset. A
  /// flat foot that rotates during its stance rotates about the ball or the ankle.
  glm::dvec3 ball_in_t_pose{0.0};
};

struct PlanSupportsOptions {
  /// Duration of the fade-in before contact and of the fade-out after it. [s]
  double ramp_s = 0.15;
  double floor_height_m = 0.0;           ///< World Y of the floor under the reference.
  std::array<bool, 2> feet{true, true};  ///< Left, right: which feet are planned.
  /// Floor to stand on, with heights relative to `floor_height_m`; null: a level floor at
  /// that height.
  const Floor* floor = nullptr;
};

/// Returns the supports of a motion's feet (Kulpa 2005, 3.1.1.1 and 4.2.4). Each stance
/// has one footprint, that of plan_feet(). On a moving floor the footprints move with it.
/// Heel and ball have tracks only for contacts without the flat foot. Intervals separated
/// by less than their ramps are merged; between them the foot keeps to the planned path.
/// Points without contact have no track. Costs frames times stances. Precondition: `map`
/// was made from the motion's skeleton; `contacts` has its frames.
[[nodiscard]] std::vector<SupportTrack> plan_supports(
    const Motion& reference,
    const BodyMap& map,
    const Contacts& contacts,
    const PlanSupportsOptions& options = {});

}  // namespace marey::retarget
