// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: a check that tags are worn on the segments that list them.

#include <span>
#include <vector>

#include "core/body.h"
#include "core/camera.h"
#include "core/result.h"
#include "reconstruct/segment_frames.h"

namespace marey::reconstruct {

/// The inputs of check_worn(): what a subject's fit has located so far.
struct WornTags {
  std::span<const Camera> cameras;
  std::span<const TagOnSegment> tags;
  std::span<const Sightings> trials;  ///< Standing, moving.
  std::span<const TagCluster> clusters;
  std::span<const ClusterPoses> standing;
  std::span<const ClusterPoses> moving;
};

/// Checks by their movement that tags are worn on the segments that they are declared on.
///
/// Errors (kBadInput, `where` "[[tags.tag]]"): tags that move as another segment does,
/// segments that are exchanged with each other, left and right exchanged on the arms, the
/// legs or both; each with what to correct. Only exchanges with which the body moves far
/// better are reported: a body that hardly moved passes. Cost: some seconds.
/// Precondition: two trials.
[[nodiscard]] Status check_worn(const WornTags& worn, const Proportions& average);

}  // namespace marey::reconstruct
