// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/character.h"
#include "core/human/body_track.h"
#include "core/motion.h"
#include "retarget/body/body_map.h"

namespace marey::retarget {

/// Computes the centre of mass and the sole points of every frame of a motion. The heel
/// is rigid with the ankle. The ball is the toe joint, lowered to the sole; ball and tip
/// turn with the toes, or with the foot of a body without toes. Linear in frames.
/// Preconditions: `map` was made from the motion's skeleton; `masses` are on its joints
/// and their sum is above 0.
[[nodiscard]] BodyTrack body_track(const Motion& motion,
                                   const BodyMap& map,
                                   std::span<const PointMass> masses);

}  // namespace marey::retarget
