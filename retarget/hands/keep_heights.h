// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "core/motion.h"
#include "core/skeleton.h"
#include "retarget/body/arm_shift.h"
#include "retarget/body/body_map.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/body/posed_frames.h"
#include "retarget/hands/touch_constraints.h"

namespace marey::retarget {

// Keeps heights in metres on a body of another size, for reached objects but not for
// standing height: a table, a ball and a bar do not scale with the body.

/// Returns the height of the avatar's hips joint for a height `y_m` of the source's; the
/// other arguments are the standing heights of both, all above the floor. Above the
/// standing height it rises by the same metres: jumps have the same height and duration.
/// Below 0.3 of the lower standing height it is equal in metres, so that chairs have the
/// same height. Between these it is interpolated, increasing in `y_m` with continuous
/// slope. If a hips joint is not above the floor in standing, it rises by the same metres
/// throughout.
[[nodiscard]] double kept_hips_height_m(double y_m,
                                        double source_stands_m,
                                        double avatar_stands_m);

/// Raises feet to the height of the source's, relative to standing: not at all below 0.1
/// legs, completely above 0.6. The leg rotates about its hip at constant length, within
/// its reach. Called before ground adaptation: `poses` are the avatar's, in the world,
/// one per frame of the source, over a floor at `floor_m`. `rests_m` is the height of the
/// source's ankles when standing, left and right. Linear in frames.
void keep_foot_heights(const Motion& source,
                       const BodyMap& source_map,
                       const std::array<double, 2>& rests_m,
                       const Skeleton& avatar,
                       const BodyMap& avatar_map,
                       double floor_m,
                       std::span<NormalizedPose> poses);

/// Raises wrists to the source's height above `source_floor_m` while its arm reaches:
/// extended by more than 0.75 (completely from 0.92) and raised by more than 50 degrees
/// from hanging (completely from 75). The arm rotates about its shoulder at constant
/// length, within its reach. Adds to `shifts`. Linear in frames. Precondition: both have
/// the same frames; `shifts` has one element per frame.
void keep_hand_heights(const Arms& source,
                       double source_floor_m,
                       const Arms& avatar,
                       ArmShifts& shifts);

}  // namespace marey::retarget
