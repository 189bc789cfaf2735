// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "core/motion.h"
#include "core/result.h"
#include "core/skeleton.h"
#include "recordings/mesh.h"

namespace tinygltf {
class Model;
}

namespace marey::recordings {

/// A node's transform in its parent, in glTF's three parts.
struct NodePose {
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 translation{0.0};
  glm::dvec3 scale{1.0};
};

/// The nodes of a file, checked: every index is in range and nothing is its own ancestor.
struct NodeTree {
  std::vector<NodePose> rest;
  std::vector<std::optional<std::size_t>> parent;
  std::vector<std::size_t> parents_first;
  /// marey's world from the file's: the half turn of a VRM 0.x.
  glm::dquat world_from_file{1.0, 0.0, 0.0, 0.0};
};

/// Every node in marey's world: its place and scale, and its rotation alone.
struct PlacedNodes {
  std::vector<glm::dmat4> world_from_node;
  std::vector<glm::dquat> rotation;
};
[[nodiscard]] PlacedNodes place_nodes(const NodeTree& tree,
                                      std::span<const NodePose> poses);
/// The node's place is a number within kFurthest_m, and its rotation is one.
[[nodiscard]] bool is_near(const PlacedNodes& placed, std::size_t node);

/// Skeleton and the nodes its joints are.
struct NodeSkeleton {
  Skeleton skeleton;
  std::vector<std::size_t> node_of_joint;
  std::vector<std::optional<JointIndex>> joint_of_node;  ///< One per node.
};

/// The model under this name in error messages.
struct NamedModel {
  const tinygltf::Model& model;
  std::string file;

  [[nodiscard]] Error fail(std::string cause) const;
};

/// Which bone each node is, by the first humanoid extension there is, else by name.
/// `faces_back` becomes true for a VRM 0.x, whose bodies face -Z.
[[nodiscard]] std::map<std::size_t, HumanBone> bones_of(const tinygltf::Model& model,
                                                        bool& faces_back);

/// See Character::skeleton and read_character()'s errors.
[[nodiscard]] Result<NodeSkeleton> skeleton_of(
    const NamedModel& file,
    const NodeTree& tree,
    const std::map<std::size_t, HumanBone>& bones);

/// The nodes' poses when the joints of the skins are where these were bound; nullopt when
/// they rest there already (to 5 degrees), or when no place of the skin in the world
/// gives its bones the lengths that the nodes have.
[[nodiscard]] Result<std::optional<std::vector<NodePose>>> bound_poses(
    const NamedModel& file, const NodeTree& tree, const NodeSkeleton& body);

/// The numbers of an accessor, row after row, `components` each; normalized integers as
/// fractions. Checks that they lie within their buffer.
[[nodiscard]] Result<std::vector<double>> accessor_values(const NamedModel& file,
                                                          int accessor,
                                                          std::size_t components);

/// All skinned triangles in the rest pose; nullopt when there are none.
[[nodiscard]] Result<std::optional<SkinnedMesh>> read_skinned_mesh(
    const NamedModel& file, const NodeTree& tree, const NodeSkeleton& body);

/// The vertices of one skinned mesh in their bind pose.
struct BoundSkin {
  std::vector<glm::dmat4> joint_from_bound;  ///< One per joint of the skin.
  std::vector<JointIndex> joints;            ///< Likewise, in the body's skeleton.
  std::vector<glm::dvec3> p_in_bound;
  /// Per vertex: weights, which sum to 1, and places in `joints`.
  std::vector<std::array<std::pair<double, std::size_t>, 4>> carriers;
};
/// Reads the vertices of all skinned meshes. Errors: read_skinned_mesh()'s.
[[nodiscard]] Result<std::vector<BoundSkin>> read_bound_skins(const NamedModel& file,
                                                              const NodeSkeleton& body);

/// Parses the bytes of a file into a model, its nodes and its skeleton with the bones.
/// Errors: read_character()'s.
[[nodiscard]] Status load_nodes(const std::string& bytes,
                                const std::filesystem::path& path,
                                tinygltf::Model& model,
                                NodeTree& tree,
                                NodeSkeleton& body);

/// Receives world_from_joint of all joints of one frame, scale included.
using EachFrame = std::function<void(std::span<const glm::dmat4> world_from_joint)>;

/// The first animation, as Character explains it; no poses when there is none.
struct ReadAnimation {
  std::optional<Motion> motion;
  double ignored_translation_m = 0.0;
};
[[nodiscard]] Result<ReadAnimation> read_animation(const NamedModel& file,
                                                   const NodeTree& tree,
                                                   const NodeSkeleton& body,
                                                   const EachFrame& each = {});

}  // namespace marey::recordings
