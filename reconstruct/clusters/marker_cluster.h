// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

namespace marey::reconstruct {

/// The markers of one segment over time: frame after frame, `markers` entries each;
/// nullopt if a marker was not seen.
struct MarkerCluster {
  std::size_t markers = 0;
  std::vector<std::optional<glm::dvec3>> p_in_world;  ///< [m]
};

}  // namespace marey::reconstruct
