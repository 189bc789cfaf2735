// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/ids.h"
#include "core/pose.h"
#include "core/skeleton.h"

namespace marey::recordings {

/// The joints that deform a vertex, and their weights. Weights are >= 0 and sum to 1,
/// largest first; a joint of weight 0 is JointIndex{0}.
struct SkinWeights {
  std::array<JointIndex, 4> joints{};
  std::array<double, 4> weights{};
};

struct MeshMaterial {
  std::string name;
  glm::dvec3 base_colour{0.8};  ///< Linear red, green, blue in 0..1.
  double roughness = 0.7;
};

/// Triangles of one material.
struct MeshPart {
  MeshMaterial material;
  /// Three vertex indices each, counter-clockwise from outside.
  std::vector<std::uint32_t> triangles;
};

/// A surface bound to a skeleton in its rest pose.
struct SkinnedMesh {
  std::vector<glm::dvec3> p_in_world;       ///< In the rest pose. [m]
  std::vector<glm::dvec3> normal_in_world;  ///< Unit. In the rest pose.
  std::vector<SkinWeights> skin;            ///< Joints of its skeleton.
  std::vector<MeshPart> parts;
};

/// Returns the positions of the vertices in `pose`, by linear blend skinning. [m, world]
/// Precondition: the mesh is bound to `skeleton`. Linear in vertices.
[[nodiscard]] std::vector<glm::dvec3> posed_vertices(const SkinnedMesh& mesh,
                                                     const Skeleton& skeleton,
                                                     const Pose& pose);

}  // namespace marey::recordings
