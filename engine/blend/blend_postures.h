// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "engine/blend/blend_sides.h"
#include "engine/blend/posture_groups.h"

#include "core/engine/blend_posture.h"

namespace marey::engine {

/// Interpolates two frames of one clip: rotations by slerp on the shorter arc (a
/// polynomial to 1e-6 rad for frames up to 60 degrees apart; exact at both ends),
/// twists on the shorter arc, all other values linearly. `at` in [0, 1]. Allocates
/// nothing; written for lanes.
void interpolate(const BlendPosture& a,
                 const BlendPosture& b,
                 float at,
                 BlendPosture& out);

/// Blends postures with weights by group: rotations as mean_rotation() (of two by slerp),
/// twists after wrapping to within a half turn of the heaviest one's, all other values
/// linearly. Weights of a group are normalised to one; a source of weight 0 leaves the
/// group to the bit, and one source alone is copied to the bit. A group without weight
/// keeps `out` as it was. Sources are summed in their order. `sides` is updated; nullptr:
/// the heaviest decides. Allocates nothing; written for lanes.
/// Precondition: as many weights as sources, at most kMaxBlended; weights >= 0, finite.
void blend_postures(std::span<const BlendPosture* const> sources,
                    std::span<const PerGroup> weights,
                    BlendSides* sides,
                    BlendPosture& out);

}  // namespace marey::engine
