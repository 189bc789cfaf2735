// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the markers of one segment as one rigid thing.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/transform.h"
#include "reconstruct/joint_between_clusters.h"

namespace marey::reconstruct {

/// So many markers tell where their segment is.
inline constexpr std::size_t kLeastOfCluster = 3;

/// Those that are there in a frame, in order.
[[nodiscard]] std::vector<std::size_t> seen_markers(const MarkerCluster& cluster,
                                                    std::size_t frame);

/// cluster_from_world of one frame, by the markers that are there: at least one.
[[nodiscard]] RigidTransform locate(const MarkerCluster& cluster,
                                    const std::vector<glm::dvec3>& shape,
                                    std::size_t frame);

/// The mean shape over the frames, about its middle. nullopt when the markers are on a
/// line, or one is never seen with enough others. Precondition: a frame, of at least
/// kLeastOfCluster markers each.
[[nodiscard]] std::optional<std::vector<glm::dvec3>> find_shape(
    const MarkerCluster& cluster, std::span<const std::size_t> frames);

}  // namespace marey::reconstruct
