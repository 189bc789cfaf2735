// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: geometry of tags on a segment, before anything is fitted.

#include <span>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "reconstruct/segment_frames.h"

namespace marey::reconstruct {

/// Returns the rotation that takes the directions a1, a2 (made perpendicular, a1 kept) of
/// one frame onto b1, b2 of another.
[[nodiscard]] glm::dquat rotation_onto(glm::dvec3 a1,
                                       glm::dvec3 a2,
                                       glm::dvec3 b1,
                                       glm::dvec3 b2);

/// Returns a place inside the body, in the cluster's frame [m]: where the lines through
/// the tags' middles along their normals come nearest to each other, some 7 cm under the
/// tags.
[[nodiscard]] glm::dvec3 place_inside(const TagCluster& cluster);

/// Returns each segment's medoid: the pose that all its others are nearest to. A person
/// who stands still has one.
[[nodiscard]] ClusterPoses medoid_poses(std::span<const ClusterPoses> frames);

}  // namespace marey::reconstruct
