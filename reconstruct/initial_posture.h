// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: a posture good enough to start a solver from.

#include <array>
#include <map>
#include <optional>

#include "core/humanoid.h"
#include "reconstruct/posture.h"

namespace marey::reconstruct {

/// The posture in which the segments stand where they were found, each limb by its own
/// bones; what was not found keeps its place relative to its parent in `fallback`.
///
/// `world_from_segment` holds any subset of the bones, in the T-pose convention of
/// posture.h. Exact when all segments agree with the lengths.
[[nodiscard]] Posture posture_from_segments(
    const std::map<HumanBone, RigidTransform>& world_from_segment,
    const Lengths& lengths,
    const BodyFrame& body,
    const Posture& fallback);

/// The same of an entry per bone. Allocates nothing.
using FoundSegments = std::array<std::optional<RigidTransform>, kHumanBoneCount>;
[[nodiscard]] Posture posture_from_segments(const FoundSegments& world_from_segment,
                                            const Lengths& lengths,
                                            const BodyFrame& body,
                                            const Posture& fallback);

/// The posture one frame on, every block moving on at `share` of the speed it had.
[[nodiscard]] Posture extrapolate(const Posture& before,
                                  const Posture& now,
                                  double share);

}  // namespace marey::reconstruct
