// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: finds tags that are not worn on the segments that list them.

#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/body.h"
#include "core/camera.h"
#include "reconstruct/segments/segment_frames.h"

namespace marey::reconstruct {

/// The inputs of find_suspect_tags(): intermediate results of a subject's fit.
struct WornTags {
  std::span<const Camera> cameras;
  std::span<const TagOnSegment> tags;
  std::span<const Sightings> trials;  ///< Standing, moving.
  std::span<const TagCluster> clusters;
  std::span<const ClusterPoses> standing;
  std::span<const ClusterPoses> moving;
};

/// Single tags that seem to move as another segment than theirs does. If few frames show
/// two tags together, a limb that was still in all of them looks the same, so a body that
/// explains these tags as declared refutes the suspicion.
struct SuspectTags {
  Error error;                    ///< kBadInput, "[[tags.tag]]", with the correction.
  std::vector<std::size_t> tags;  ///< By position in WornTags::tags.
};

/// Checks by their movement that tags are worn on the segments that they are declared on.
/// Returns the single tags that are suspect, or nullopt.
/// Errors (kBadInput, `where` "[[tags.tag]]"): segments that are exchanged with each
/// other, left and right exchanged on the arms, the legs or both; each with the
/// correction. Only exchanges that improve the body's movement by far are reported: a
/// body that hardly moved passes. Cost: some seconds. Precondition: two trials.
[[nodiscard]] Result<std::optional<SuspectTags>> find_suspect_tags(
    const WornTags& worn, const Proportions& average);

}  // namespace marey::reconstruct
