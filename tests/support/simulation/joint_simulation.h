// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

namespace marey::testing {

struct JointSimulationOptions {
  double cone_rad = 0.7;    ///< From side to side: the joint is turned by up to half.
  bool around_rim = false;  ///< Round the cone's rim; else evenly all over the cone.
  int frames = 300;
  double noise_m = 0.001;      ///< Standard deviation of a marker's coordinate.
  double soft_tissue_m = 0.0;  ///< Root mean square, on the second cluster's markers.
  double dropouts = 0.0;       ///< Share of samples that are not there.
  std::uint64_t seed = 1;
};

/// Two clusters of four markers, the corners of a tetrahedron of +-50 mm, each 150 mm
/// from the ball joint between them. The joint turns about axes across the clusters,
/// within the cone; the first segment moves about freely. Soft tissue carries each
/// marker of the second cluster in proportion to the joint's rotation vector, by a random
/// matrix of its own.
struct JointSimulation {
  static constexpr std::size_t kMarkers = 4;  ///< Markers per cluster.
  /// Frame after frame, kMarkers of them each. [m]
  std::vector<std::optional<glm::dvec3>> a_in_world;
  std::vector<std::optional<glm::dvec3>> b_in_world;
  std::vector<glm::dvec3> shape_in_a;  ///< True, and so for b. [m]
  std::vector<glm::dvec3> shape_in_b;
  glm::dvec3 joint_in_a{0.0};
  glm::dvec3 joint_in_b{0.0};
};

[[nodiscard]] JointSimulation simulate_joint(const JointSimulationOptions& options);

}  // namespace marey::testing
