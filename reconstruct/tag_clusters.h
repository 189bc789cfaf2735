// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/body.h"
#include "core/camera.h"
#include "reconstruct/sightings.h"

namespace marey::reconstruct {

/// The tags of one segment as one rigid thing, in the frame of one of them. Tags that
/// were never seen together with the others are absent.
struct TagCluster {
  HumanBone segment{};
  std::map<std::size_t, RigidTransform>
      cluster_from_tag;  ///< By position in the tag list.
};

/// Where every tag is relative to the other tags of its segment: per pair the relative
/// pose that most common sightings agree with, along the tree of most sightings. Poses
/// that a single camera sees ambiguously do not count. A first guess for the subject's
/// fit, good to a few millimetres and degrees.
[[nodiscard]] std::vector<TagCluster> cluster_tags(std::span<const Camera> cameras,
                                                   std::span<const TagOnSegment> tags,
                                                   std::span<const Sightings> trials);

/// world_from_tag of one tag in one frame, from all cameras that see it. nullopt when
/// none does, or a single one so that it could just as well be tilted the other way, or
/// they do not agree.
[[nodiscard]] std::optional<RigidTransform> locate_tag(
    std::size_t tag,
    std::span<const Camera> cameras,
    std::span<const TagOnSegment> tags,
    std::span<const TagSighting> frame);

/// The pose that most of `candidates` are within `near` of (metres, a radian counting as
/// 0.1 m), averaged over those; nullopt when fewer than three are. Quadratic in their
/// number.
[[nodiscard]] std::optional<RigidTransform> agreed_pose(
    std::span<const RigidTransform> candidates, double near);

/// Where a cluster is in one frame, from all corners that any camera sees of it. nullopt
/// when it is not seen, or only so that it could just as well be tilted the other way.
[[nodiscard]] std::optional<RigidTransform> locate_cluster(
    const TagCluster& cluster,
    std::span<const Camera> cameras,
    std::span<const TagOnSegment> tags,
    std::span<const TagSighting> frame);

}  // namespace marey::reconstruct
