// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "tests/support/simulation/simulated_body.h"

namespace marey::testing {

/// A part of the body that no camera looks through, rigid with one bone: a capsule around
/// the line from `a` to `b` of radius `radii.x`, or an ellipsoid about `a` with axes
/// parallel to the bone's when `a` equals `b`.
struct SoftTissuePart {
  HumanBone bone{};
  glm::dvec3 a{0.0};
  glm::dvec3 b{0.0};
  glm::dvec3 radii{0.0};
};

/// The whole body, some thirty parts. [m]
[[nodiscard]] std::vector<SoftTissuePart> soft_tissue_of(const SimulatedBody& body);

/// A point on the skin and the direction that its surface faces.
struct SkinPoint {
  glm::dvec3 p_in_bone{0.0};
  glm::dvec3 out{0.0};
};

/// Returns the last point at which a ray from inside the soft tissue of `bone` leaves it.
/// Parts of other bones do not count.
[[nodiscard]] SkinPoint skin_point(std::span<const SoftTissuePart> soft_tissue,
                                   HumanBone bone,
                                   const glm::dvec3& from_in_bone,
                                   const glm::dvec3& direction);

/// Returns true when soft tissue hides a point from an eye. The radii of `own`'s parts
/// are reduced by `thinner_m`, so that a plate on these parts does not sink in.
[[nodiscard]] bool is_hidden(std::span<const SoftTissuePart> soft_tissue,
                             const BoneFrames& world_from_bone,
                             const glm::dvec3& p_in_world,
                             const glm::dvec3& eye_in_world,
                             HumanBone own,
                             double thinner_m);

}  // namespace marey::testing
