// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace marey::reconstruct {

/// The markers of one segment over time: frame after frame, `markers` of them each;
/// nullopt where one was not seen.
struct MarkerCluster {
  std::size_t markers = 0;
  std::vector<std::optional<glm::dvec3>> p_in_world;  ///< [m]
};

struct ClusterJointOptions {
  double noise_m = 0.001;  ///< Standard deviation of a marker's coordinate.
};

/// A ball joint between two clusters.
struct ClusterJoint {
  /// Of each cluster the mean shape, in a frame of its own with the origin in its middle.
  std::vector<glm::dvec3> shape_a;
  std::vector<glm::dvec3> shape_b;
  glm::dvec3 p_in_a{0.0};  ///< The joint's centre in the frame of shape_a. [m]
  glm::dvec3 p_in_b{0.0};
  double sigma_a_m = 0.0;  ///< Standard deviation per coordinate, root mean square.
  double sigma_b_m = 0.0;
  double rms_m = 0.0;  ///< Of what markers stray from the model, per coordinate.
  /// How far soft tissue was found to carry the markers with the joint's rotation,
  /// root mean square over the movement.
  double soft_tissue_a_m = 0.0;
  double soft_tissue_b_m = 0.0;
};

/// The centre of a ball joint from markers on both of its segments: one least squares
/// problem over the poses of both segments in every frame, hinged at the centre, the
/// clusters' shapes, and how each marker is carried along its segment in proportion to
/// the joint's rotation (soft tissue; after the pose-linear part of Alexander &
/// Andriacchi 2001). What the markers of a cluster move against each other says how much
/// of that is to be expected, so that firm clusters do not pay for it. Robust against
/// single wrong markers (Cauchy), any of which may be missing in any frame.
///
/// nullopt with fewer than 20 frames that show three markers of each cluster, or clusters
/// on a line. Deterministic. Cost: some 0.1 ms per frame.
/// Precondition: as many frames of both.
[[nodiscard]] std::optional<ClusterJoint> joint_between_clusters(
    const MarkerCluster& a,
    const MarkerCluster& b,
    const ClusterJointOptions& options = {});

}  // namespace marey::reconstruct
