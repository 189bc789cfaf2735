// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/body.h"
#include "core/camera.h"
#include "reconstruct/clusters/sightings.h"

namespace marey::reconstruct {

/// The tags of one segment as one rigid body, in the frame of one of them. Tags that were
/// never seen together with the others are absent.
struct TagCluster {
  HumanBone segment{};
  std::map<std::size_t, RigidTransform>
      cluster_from_tag;  ///< By position in the tag list.
};

/// world_from_cluster of every cluster located in one frame, by segment.
using ClusterPoses = std::map<HumanBone, RigidTransform>;

/// Computes the pose of every tag relative to the other tags of its segment: per pair the
/// relative pose that most common sightings agree with, along the tree of most sightings.
/// Ambiguous poses from a single camera are ignored. An initial estimate for the
/// subject's fit, accurate to a few millimetres and degrees.
[[nodiscard]] std::vector<TagCluster> cluster_tags(std::span<const Camera> cameras,
                                                   std::span<const TagOnSegment> tags,
                                                   std::span<const Sightings> trials);

/// Computes world_from_tag of one tag in one frame, from all cameras that see it. nullopt
/// if none does, if a single camera sees it ambiguously, or if the cameras do not agree.
[[nodiscard]] std::optional<RigidTransform> locate_tag(
    std::size_t tag,
    std::span<const Camera> cameras,
    std::span<const TagOnSegment> tags,
    std::span<const TagSighting> frame);

/// Returns the mean of the largest set of `candidates` that are within `near` of one pose
/// (metres, a radian counting as 0.1 m); nullopt for fewer than three. Quadratic in their
/// number.
[[nodiscard]] std::optional<RigidTransform> agreed_pose(
    std::span<const RigidTransform> candidates, double near);

/// Computes world_from_cluster in one frame, from all corners that any camera sees of it.
/// nullopt if it is not seen, or only ambiguously by a single camera.
[[nodiscard]] std::optional<RigidTransform> locate_cluster(
    const TagCluster& cluster,
    std::span<const Camera> cameras,
    std::span<const TagOnSegment> tags,
    std::span<const TagSighting> frame);

}  // namespace marey::reconstruct
