// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/time.h"
#include "retarget/arm_clearance.h"
#include "retarget/arm_shift.h"
#include "retarget/keep_touches.h"

namespace marey::retarget {

struct ClearArmsOptions {
  /// An arm begins to give way this long before it must, and comes back as long after.
  double anticipation_s = 0.3;
  double slack_m = kArmSlack_m;  ///< So much of what is missing is left. [m]
  int most_passes = 8;
  /// Hands stay over the floor, Y = 0 (without a skin as far as the source's are).
  bool over_floor = true;
  /// Nearer than this to what is wanted ends the passes. [m]
  double good_enough_m = 0.001;
};

struct ClearArmsReport {
  /// How deep arms were, and are, in trunk and thighs, and hands in the floor, beyond what
  /// the source's are, slack included. [m]
  double deepest_before_m = 0.0;
  double deepest_after_m = 0.0;
  int worst_frame = -1;  ///< Of what is left; -1: nothing is.
  int passes = 0;
};

/// Moves elbows, forearms and hands out of the avatar's trunk and thighs, as far as the
/// source's were out of its own: where the source is outside, to the surface; where it is
/// inside, no deeper. They leave on the side on which the source has them, however far
/// within they are. The elbow swings about the line from shoulder to wrist as far as that
/// helps, the wrist moves for the rest, and what hands hold (`holds`) they keep. A hand
/// that would be in the floor, since arms are long where legs are short, is lifted over it
/// by its elbow; `world` says where the source's floor is. All with
/// continuous speed and acceleration: what is missing is covered smoothly over time
/// (retarget/smooth_cover.h) and added, again until little is missing. A body that is in
/// nobody's way changes by nothing. Adds to `shifts`. Some microseconds a frame and pass.
/// Precondition: as keep_touches()'s.
ClearArmsReport clear_arms(const VolumeInMotion& source,
                           const VolumeInMotion& avatar,
                           const Arms& arms,
                           FrameRate rate,
                           const WorldScale& world,
                           const HandHolds& holds,
                           const ClearArmsOptions& options,
                           ArmShifts& shifts);

}  // namespace marey::retarget
