// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: number of frames in which a segment's own tags determine its
// pose.

#include <array>
#include <span>

#include "core/body.h"
#include "core/camera.h"
#include "reconstruct/clusters/sightings.h"

namespace marey::reconstruct {

/// Counts, by segment, the frames that locate it: two sightings of its tags, or one whose
/// two poses (planar_poses()) differ in the picture. Precondition: `trial` was grouped
/// from `tags`. Cost: some 10 microseconds per sighting.
[[nodiscard]] std::array<int, kHumanBoneCount> located_frames(
    const Sightings& trial,
    std::span<const TagOnSegment> tags,
    std::span<const Camera> cameras);

}  // namespace marey::reconstruct
