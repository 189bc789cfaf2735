// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/gltf/posed_places.h"

#include <algorithm>
#include <limits>
#include <span>
#include <string>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <tiny_gltf.h>

#include "recordings/base/atomic_file.h"
#include "recordings/gltf/gltf_model.h"

namespace marey::recordings {
namespace {

/// Returns the row of a matrix that yields a point's world Y.
glm::dvec4 y_row(const glm::dmat4& m) {
  return {m[0][1], m[1][1], m[2][1], m[3][1]};
}

double lowest_of(const BoundSkin& skin, std::span<const glm::dmat4> world_from_joint) {
  std::vector<glm::dvec4> rows;
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    rows.push_back(
        y_row(world_from_joint[index(skin.joints[i])] * skin.joint_from_bound[i]));
  }
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < skin.p_in_bound.size(); ++v) {
    glm::dvec4 row(0.0);
    for (const auto& [weight, joint] : skin.carriers[v]) row += weight * rows[joint];
    lowest = std::min(lowest, glm::dot(row, glm::dvec4(skin.p_in_bound[v], 1.0)));
  }
  return lowest;
}

}  // namespace

Result<PosedPlaces> read_posed_places(const std::filesystem::path& path) {
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return bytes.error();
  tinygltf::Model model;
  NodeTree tree;
  NodeSkeleton body;
  if (const Status ok = load_nodes(*bytes, path, model, tree, body); !ok) {
    return ok.error();
  }
  const NamedModel file{model, path.string()};
  const auto skins = read_bound_skins(file, body);
  if (!skins) return skins.error();
  PosedPlaces out;
  const auto add = [&](std::span<const glm::dmat4> world_from_joint) {
    std::vector<glm::dvec3>& places = out.joints.emplace_back();
    for (const glm::dmat4& joint : world_from_joint) places.emplace_back(joint[3]);
    if (skins->empty()) return;
    double lowest = std::numeric_limits<double>::infinity();
    for (const BoundSkin& skin : *skins) {
      lowest = std::min(lowest, lowest_of(skin, world_from_joint));
    }
    out.lowest_skin.push_back(lowest);
  };
  const auto animation = read_animation(file, tree, body, add);
  if (!animation) return animation.error();
  return out;
}

}  // namespace marey::recordings
