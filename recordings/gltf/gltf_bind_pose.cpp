// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <tiny_gltf.h>

#include "recordings/gltf/gltf_model.h"

namespace marey::recordings {
namespace {

constexpr double kSameRotation = 0.0872;  // 5 degrees.
constexpr double kSameLength = 0.05;

/// Bind transform of each node, in the space of a skin's vertices.
using BoundNodes = std::vector<std::optional<glm::dmat4>>;

/// Returns the rotation of a matrix without its scale; nullopt if it is singular or
/// mirrored.
std::optional<glm::dquat> rotation_of(const glm::dmat4& matrix) {
  glm::dmat3 axes(matrix);
  for (int i = 0; i < 3; ++i) {
    const double length = glm::length(axes[i]);
    if (!(length > 1e-12 && length < 1e12)) return std::nullopt;
    axes[i] /= length;
  }
  if (!(glm::determinant(axes) > 0.5)) return std::nullopt;
  return glm::normalize(glm::quat_cast(axes));
}

Result<BoundNodes> bound_nodes(const NamedModel& file,
                               const tinygltf::Skin& skin,
                               std::size_t nodes) {
  BoundNodes bound(nodes);
  if (skin.inverseBindMatrices < 0) return bound;
  const auto values = accessor_values(file, skin.inverseBindMatrices, 16);
  if (!values) return values.error();
  for (std::size_t i = 0; i < skin.joints.size() && 16 * (i + 1) <= values->size(); ++i) {
    glm::dmat4 joint_from_bound(1.0);
    for (std::size_t k = 0; k < 16; ++k) {
      joint_from_bound[static_cast<int>(k / 4)][static_cast<int>(k % 4)] =
          (*values)[16 * i + k];
    }
    if (!rotation_of(joint_from_bound)) continue;
    bound[static_cast<std::size_t>(skin.joints[i])] = glm::inverse(joint_from_bound);
  }
  return bound;
}

/// Agreement of a placement of the skin in the world with the nodes.
struct Agreement {
  double length_ratio = 0.0;  ///< Over all bones: bind length divided by rest length.
  double mean_turn = 0.0;     ///< Mean over the joints. [rad]
  double worst_turn = 0.0;
};

double turn_between(const glm::dquat& a, const glm::dquat& b) {
  return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b))));
}

Agreement agreement(const NodeTree& tree,
                    const PlacedNodes& placed,
                    const BoundNodes& bound,
                    const glm::dmat4& world_from_skin) {
  Agreement out;
  double rest = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < bound.size(); ++i) {
    if (!bound[i]) continue;
    const glm::dmat4 world = world_from_skin * *bound[i];
    const auto rotation = rotation_of(world);
    if (!rotation) continue;
    const double turn = turn_between(*rotation, placed.rotation[i]);
    out.mean_turn += turn;
    out.worst_turn = std::max(out.worst_turn, turn);
    count += 1.0;
    const auto above = tree.parent[i];
    if (!above || !bound[*above]) continue;
    const glm::dvec3 to(world[3]);
    const glm::dvec3 from((world_from_skin * *bound[*above])[3]);
    out.length_ratio += glm::distance(to, from);
    rest += glm::distance(glm::dvec3(placed.world_from_node[i][3]),
                          glm::dvec3(placed.world_from_node[*above][3]));
  }
  if (count > 0.0) out.mean_turn /= count;
  out.length_ratio = rest > 0.0 ? out.length_ratio / rest : 0.0;
  return out;
}

/// Returns the candidate placement of the skin that has the nodes' lengths and the
/// smallest rotations; nullopt if none has the lengths.
std::optional<glm::dmat4> place_of_skin(const NodeTree& tree,
                                        const PlacedNodes& placed,
                                        const BoundNodes& bound,
                                        std::size_t mesh_node,
                                        std::size_t root_node,
                                        Agreement& best) {
  const glm::dmat4 world = glm::mat4_cast(tree.world_from_file);
  std::vector<glm::dmat4> places{placed.world_from_node[mesh_node], world};
  if (tree.parent[root_node]) {
    places.push_back(placed.world_from_node[*tree.parent[root_node]]);
  }
  std::optional<glm::dmat4> chosen;
  for (const glm::dmat4& place : places) {
    const Agreement one = agreement(tree, placed, bound, place);
    const bool fits = std::abs(one.length_ratio - 1.0) < kSameLength;
    if (!fits || (chosen && one.mean_turn > best.mean_turn - 1e-3)) continue;
    chosen = place;
    best = one;
  }
  return chosen;
}

NodePose local_pose(const glm::dmat4& parent, const glm::dmat4& world) {
  const glm::dmat4 local = glm::inverse(parent) * world;
  NodePose pose;
  for (int i = 0; i < 3; ++i) pose.scale[i] = glm::length(glm::dvec3(local[i]));
  pose.rotation = rotation_of(local).value_or(glm::dquat(1.0, 0.0, 0.0, 0.0));
  pose.translation = glm::dvec3(local[3]);
  return pose;
}

}  // namespace

Result<std::optional<std::vector<NodePose>>> bound_poses(const NamedModel& file,
                                                         const NodeTree& tree,
                                                         const NodeSkeleton& body) {
  using Poses = std::optional<std::vector<NodePose>>;
  const PlacedNodes placed = place_nodes(tree, tree.rest);
  std::vector<std::optional<glm::dmat4>> world(tree.rest.size());
  double worst_turn = 0.0;
  for (std::size_t n = 0; n < file.model.nodes.size(); ++n) {
    const tinygltf::Node& node = file.model.nodes[n];
    if (node.mesh < 0 || node.skin < 0) continue;
    if (static_cast<std::size_t>(node.skin) >= file.model.skins.size()) continue;
    const auto& skin = file.model.skins[static_cast<std::size_t>(node.skin)];
    const auto bound = bound_nodes(file, skin, tree.rest.size());
    if (!bound) return bound.error();
    Agreement agreed;
    const auto place =
        place_of_skin(tree, placed, *bound, n, body.node_of_joint[0], agreed);
    if (!place) return Poses{};
    worst_turn = std::max(worst_turn, agreed.worst_turn);
    for (std::size_t i = 0; i < bound->size(); ++i) {
      if ((*bound)[i] && !world[i]) world[i] = *place * *(*bound)[i];
    }
  }
  if (worst_turn < kSameRotation) return Poses{};
  std::vector<NodePose> poses = tree.rest;
  for (const std::size_t node : tree.parents_first) {
    const auto above = tree.parent[node];
    const glm::dmat4 parent =
        above ? *world[*above] : glm::mat4_cast(tree.world_from_file);
    if (world[node]) {
      poses[node] = local_pose(parent, *world[node]);
    } else {
      const NodePose& pose = poses[node];
      glm::dmat4 local = glm::mat4_cast(pose.rotation);
      for (int i = 0; i < 3; ++i) local[i] *= pose.scale[i];
      local[3] = glm::dvec4(pose.translation, 1.0);
      world[node] = parent * local;
    }
  }
  return Poses{std::move(poses)};
}

}  // namespace marey::recordings
