// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "engine/blend/blend_sides.h"

#include "core/engine/blend_posture.h"

/// Kernels of interpolate() and blend_postures() over the rotations of postures.
namespace marey::engine {

/// Interpolates every rotation at the same place of its shorter arc. `out` is neither of
/// the postures.
void interpolate_rotations(const BlendPosture& a,
                           const BlendPosture& b,
                           float at,
                           BlendPosture& out);

/// Place of each rotation between the first (0) and the second posture (1), both exact;
/// below 0: `out` stays as it is.
using LanePlaces = BlendPosture::Rotations;

/// Blends the rotations of two postures. `sides` must be known and is updated.
void blend_two_rotations(const BlendPosture& a,
                         const BlendPosture& b,
                         const LanePlaces& at,
                         BlendSides& sides,
                         BlendPosture& out);

/// Weights of up to kMaxBlended postures per rotation, with their sum.
struct LaneWeights {
  std::array<BlendPosture::Rotations, kMaxBlended> of_source;
  BlendPosture::Rotations total;
};

/// Blends the rotations of more postures by tangent steps about their weighted sum. A
/// rotation of total weight 0 stays as it is in `out`. `sides` is updated; if unknown,
/// the heaviest rotations decide. `out` is none of the postures.
void blend_many_rotations(std::span<const BlendPosture* const> sources,
                          const LaneWeights& weights,
                          BlendSides& sides,
                          BlendPosture& out);

}  // namespace marey::engine
