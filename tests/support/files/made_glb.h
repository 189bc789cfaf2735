// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace marey::testing {

struct MadeNode {
  std::string name;
  int parent = -1;
  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  double scale = 1.0;
};

/// A mesh with a skin of its own, over all nodes but the first.
struct MadeVertices {
  std::vector<glm::dvec3> places;  ///< World, in the bind pose.
  /// Which joint (node - 1) carries it by how much; they sum to 1.
  std::vector<std::array<std::pair<int, double>, 3>> carriers;
  std::vector<unsigned> triangles;
};

/// A GLB as other programs write it. Node 0 is the armature, the others are joints.
struct MadeGlb {
  std::vector<MadeNode> nodes;  ///< Parents first.
  std::vector<glm::dmat4> inverse_bind;
  std::vector<MadeVertices> meshes;
  bool byte_weights = false;
};

/// Writes it with a writer of its own. Throws std::runtime_error when the disk fails.
void write_made_glb(const MadeGlb& glb, const std::filesystem::path& path);

}  // namespace marey::testing
