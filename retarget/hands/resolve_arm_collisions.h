// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/base/time.h"
#include "retarget/body/arm_shift.h"
#include "retarget/hands/arm_clearance.h"
#include "retarget/hands/keep_touches.h"

namespace marey::retarget {

struct ArmCollisionOptions {
  /// An arm starts to move this long before a collision, and returns as long after.
  double anticipation_s = 0.3;
  double slack_m = kArmSlack_m;  ///< Errors below this remain. [m]
  int max_passes = 8;
  /// Hands stay above the floor, Y = 0 (without a skin: as far as the source's do).
  bool over_floor = true;
  /// Passes end when the error is below this. [m]
  double good_enough_m = 0.001;
};

struct ArmCollisionReport {
  /// Maximum depth of arms in trunk and thighs, and of hands in the floor, before and
  /// after, beyond the source's, slack included. [m]
  double max_depth_before_m = 0.0;
  double max_depth_after_m = 0.0;
  std::optional<int> worst_frame{};  ///< Frame of the remaining maximum; nullopt: none.
  int passes = 0;
};

/// Moves elbows, forearms and hands out of the avatar's trunk and thighs, relative to the
/// source: where the source is outside, to the surface; where it is inside, to the same
/// depth. They leave on the side of the source, at any depth. The elbow swings about the
/// line from shoulder to wrist as far as possible, and the wrist moves by the remainder.
/// Contacts of held hands (`holds`) are kept. A hand in the floor (arms may be long where
/// legs are short) is raised by its elbow; `world` defines the source's floor. All with
/// continuous speed and acceleration: the error is covered by a smooth function of time
/// (retarget/base/smooth_cover.h) and added, repeatedly until it is small. A motion
/// without such collisions is unchanged. Adds to `shifts`. Some microseconds per frame
/// and pass. Precondition: as keep_touches().
ArmCollisionReport resolve_arm_collisions(const VolumeInMotion& source,
                                          const VolumeInMotion& avatar,
                                          const Arms& arms,
                                          FrameRate rate,
                                          const WorldScale& world,
                                          const HandHolds& holds,
                                          const ArmCollisionOptions& options,
                                          ArmShifts& shifts);

}  // namespace marey::retarget
