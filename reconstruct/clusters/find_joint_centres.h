// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "core/transform.h"

namespace marey::reconstruct {

/// Two neighbouring segments at one instant.
struct SegmentPair {
  RigidTransform world_from_a;
  RigidTransform world_from_b;
};

struct JointCentre {
  glm::dvec3 p_in_a{0.0};  ///< [m]
  glm::dvec3 p_in_b{0.0};  ///< [m]
  double rms_m = 0.0;      ///< Root mean square distance between the two.
  /// Information of the movement on the centre in its weakest direction: the smallest
  /// singular value of the stacked rotations, 0 (a direction is free: a hinge) to 1.
  double observability = 0.0;
};

/// Computes the point that is at rest in both of two segments that turn relative to each
/// other (SCoRE, the symmetrical centre of rotation estimation: Ehrig et al. 2006, eq.
/// 5), robustly re-weighted (Cauchy at 10 mm).
/// A direction that the movement does not determine, such as along a hinge, is filled
/// from the expected places `near_in_a`, `near_in_b` with a weight far below any
/// measurement's. nullopt with fewer than ten instants.
[[nodiscard]] std::optional<JointCentre> find_joint_centre(
    std::span<const SegmentPair> instants,
    const glm::dvec3& near_in_a,
    const glm::dvec3& near_in_b);

}  // namespace marey::reconstruct
