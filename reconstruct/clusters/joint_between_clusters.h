// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "reconstruct/clusters/marker_cluster.h"

namespace marey::reconstruct {

struct ClusterJointOptions {
  double noise_m = 0.001;  ///< Standard deviation of a marker's coordinate.
};

/// A ball joint between two clusters.
struct ClusterJoint {
  /// Mean shape of each cluster, in a frame of its own with the origin in its middle.
  std::vector<glm::dvec3> shape_a;
  std::vector<glm::dvec3> shape_b;
  glm::dvec3 p_in_a{0.0};  ///< The joint's centre in the frame of shape_a. [m]
  glm::dvec3 p_in_b{0.0};
  double sigma_a_m = 0.0;  ///< Standard deviation per coordinate, root mean square.
  double sigma_b_m = 0.0;
  double rms_m = 0.0;  ///< Residual of the markers, per coordinate, root mean square.
  /// Estimated movement of the markers by soft tissue with the joint's rotation, root
  /// mean square over the movement.
  double soft_tissue_a_m = 0.0;
  double soft_tissue_b_m = 0.0;
};

/// Computes the centre of a ball joint from markers on both of its segments: one least
/// squares problem over the poses of both segments in every frame, hinged at the centre,
/// the clusters' shapes, and the movement of each marker along its segment in proportion
/// to the joint's rotation (soft tissue; after the pose-linear part of Alexander &
/// Andriacchi 2001). The prior of that movement comes from the relative movement of the
/// markers of a cluster, so that it does not degrade firm clusters. Robust against single
/// wrong markers (Cauchy loss). Any marker may be missing in any frame.
/// nullopt with fewer than 20 frames that show three markers of each cluster, or for
/// clusters on a line. Deterministic. Cost: some 0.1 ms per frame. Precondition: equal
/// numbers of frames.
[[nodiscard]] std::optional<ClusterJoint> joint_between_clusters(
    const MarkerCluster& a,
    const MarkerCluster& b,
    const ClusterJointOptions& options = {});

}  // namespace marey::reconstruct
