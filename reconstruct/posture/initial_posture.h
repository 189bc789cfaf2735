// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: an initial posture for a solver.

#include <array>
#include <map>
#include <optional>

#include "core/humanoid.h"
#include "reconstruct/posture/posture.h"

namespace marey::reconstruct {

/// Computes the posture in which the segments have the given poses, each limb from its
/// own bones. A segment without a pose keeps its pose relative to its parent in
/// `fallback`.
/// `world_from_segment` holds any subset of the bones, in the T-pose convention of
/// posture.h. Exact if all segments agree with the lengths.
[[nodiscard]] Posture posture_from_segments(
    const std::map<HumanBone, RigidTransform>& world_from_segment,
    const Lengths& lengths,
    const BodyConstants& body,
    const Posture& fallback);

/// Computes the same from one entry per bone. Does not allocate.
using FoundSegments = std::array<std::optional<RigidTransform>, kHumanBoneCount>;
[[nodiscard]] Posture posture_from_segments(const FoundSegments& world_from_segment,
                                            const Lengths& lengths,
                                            const BodyConstants& body,
                                            const Posture& fallback);

/// Extrapolates the posture by one frame; every block moves at `share` of its speed.
[[nodiscard]] Posture extrapolate(const Posture& before,
                                  const Posture& now,
                                  double share);

}  // namespace marey::reconstruct
