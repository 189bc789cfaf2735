// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "core/motion.h"
#include "core/skeleton.h"
#include "retarget/arm_shift.h"
#include "retarget/body_map.h"
#include "retarget/normalized_skeleton.h"
#include "retarget/posed_frames.h"
#include "retarget/touch_constraints.h"

namespace marey::retarget {

// Heights in metres on a body of another size: of what the body reaches for, not of how
// it stands. A table, a ball and a bar do not grow with who uses them.

/// The height of the avatar's hips joint where the source's is at `y_m`, while both stand
/// at these heights, all above the floor. Above that it rises by the same metres: jumps
/// are as high, and last as long as gravity has them. Below 0.3 of the lower of both it
/// is as low in metres: who sits, sits on the same seat. Between these it passes over,
/// rising with `y_m`, with continuous slope. A hips joint that is not above the floor in
/// standing rises by the same metres throughout.
[[nodiscard]] double kept_hips_height_m(double y_m,
                                        double source_stands_m,
                                        double avatar_stands_m);

/// Brings feet that are raised as high as the source's, above where each stands: by none
/// of it below 0.1 legs, by all above 0.6. The leg turns about its hip, as stretched as
/// it is, as far as it can. Before the ground: `poses` are the avatar's, in the world,
/// one per frame of the source, over a floor at `floor_m`. `rests_m` is what the source's
/// ankles are at when they stand, left and right. Linear in frames.
void keep_foot_heights(const Motion& source,
                       const BodyMap& source_map,
                       const std::array<double, 2>& rests_m,
                       const Skeleton& avatar,
                       const BodyMap& avatar_map,
                       double floor_m,
                       std::span<NormalizedPose> poses);

/// Brings wrists as high as the source's are above `source_floor_m` while its arm
/// reaches: stretched by more than 0.75 (in full from 0.92) and raised by more than 50
/// degrees from hanging down (in full from 75). The arm turns about its shoulder, as
/// stretched as it is, as far as it can. Adds to `shifts`. Linear in frames.
/// Precondition: both have the same frames; `shifts` has one per frame.
void keep_hand_heights(const Arms& source,
                       double source_floor_m,
                       const Arms& avatar,
                       ArmShifts& shifts);

}  // namespace marey::retarget
