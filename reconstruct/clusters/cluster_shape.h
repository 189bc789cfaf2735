// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the markers of one segment as one rigid body.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/transform.h"
#include "reconstruct/clusters/marker_cluster.h"

namespace marey::reconstruct {

/// Minimum number of markers that determine the pose of their segment.
inline constexpr std::size_t kMinClusterMarkers = 3;

/// Returns the markers that are seen in a frame, in order.
[[nodiscard]] std::vector<std::size_t> seen_markers(const MarkerCluster& cluster,
                                                    std::size_t frame);

/// Computes cluster_from_world of one frame from its seen markers: at least one.
[[nodiscard]] RigidTransform locate(const MarkerCluster& cluster,
                                    const std::vector<glm::dvec3>& shape,
                                    std::size_t frame);

/// Computes the mean shape over the frames, relative to its middle. nullopt if the
/// markers are on a line, or one is never seen with enough others. Precondition: at least
/// one frame, each with at least kMinClusterMarkers markers.
[[nodiscard]] std::optional<std::vector<glm::dvec3>> find_shape(
    const MarkerCluster& cluster, std::span<const std::size_t> frames);

}  // namespace marey::reconstruct
