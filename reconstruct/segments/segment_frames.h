// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: bones with names, lengths and directions from moving rigid
// clusters: the initial estimate of a subject's fit.

#include <map>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "reconstruct/clusters/tag_clusters.h"
#include "reconstruct/posture/posture.h"

namespace marey::reconstruct {

struct SegmentFrames {
  Lengths lengths{};
  BodyConstants body;
  std::map<HumanBone, RigidTransform> segment_from_cluster;
};

/// Finds joint centres between neighbouring clusters, hinge axes of elbows and knees (the
/// direction about which the limb bends: the sum of upper x lower over all frames), and
/// from the standing frames the up direction of hips, chest, head, feet and hands.
/// `standing` and `moving` are frames of a person standing still and upright, and moving
/// every joint. Quantities that the movement does not determine come from `average`.
/// Errors (kBadInput, `where` empty): a segment that must carry a tag has none, or is
/// never seen together with its neighbour.
[[nodiscard]] Result<SegmentFrames> find_segment_frames(
    std::span<const TagCluster> clusters,
    std::span<const ClusterPoses> standing,
    std::span<const ClusterPoses> moving,
    const Proportions& average);

}  // namespace marey::reconstruct
