// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: tags declared on the other side of the body.

#include <span>

#include "core/base/result.h"
#include "reconstruct/segments/exchanged_segments.h"

namespace marey::reconstruct {

/// Detects left and right exchanged on the arms, the legs or both: then knees bend
/// forward and feet point backward relative to the hips. Empty if neither is, or without
/// evidence. `found` was computed from `standing` and `moving`. Error (kBadInput): chest
/// and hips face opposite ways, and neither knees nor feet show which of them is wrong.
[[nodiscard]] Result<Renaming> exchanged_limbs(const SegmentFrames& found,
                                               std::span<const TagCluster> clusters,
                                               std::span<const ClusterPoses> standing,
                                               std::span<const ClusterPoses> moving);

}  // namespace marey::reconstruct
