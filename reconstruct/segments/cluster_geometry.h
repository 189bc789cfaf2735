// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: geometry of tags on a segment, before the fit.

#include <span>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "reconstruct/clusters/tag_clusters.h"

namespace marey::reconstruct {

/// Returns the rotation that maps the directions a1, a2 (made perpendicular, a1 kept) of
/// one frame to b1, b2 of another.
[[nodiscard]] glm::dquat rotation_onto(glm::dvec3 a1,
                                       glm::dvec3 a2,
                                       glm::dvec3 b1,
                                       glm::dvec3 b2);

/// Returns a place inside the body, in the cluster's frame [m]: the point nearest to the
/// lines through the tags' middles along their normals, some 7 cm under the tags.
[[nodiscard]] glm::dvec3 place_inside(const TagCluster& cluster);

/// Returns each segment's medoid: the pose with the smallest distances to all others. A
/// person who stands still has one.
[[nodiscard]] ClusterPoses medoid_poses(std::span<const ClusterPoses> frames);

}  // namespace marey::reconstruct
