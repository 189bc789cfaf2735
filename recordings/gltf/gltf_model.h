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

#include "core/base/result.h"
#include "core/motion.h"
#include "core/skeleton.h"
#include "recordings/body/mesh.h"

namespace tinygltf {
class Model;
}

namespace marey::recordings {

/// A node's transform in its parent: glTF's rotation, translation and scale.
struct NodePose {
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 translation{0.0};
  glm::dvec3 scale{1.0};
};

/// The checked nodes of a file: every index is in range and there are no cycles.
struct NodeTree {
  std::vector<NodePose> rest;
  std::vector<std::optional<std::size_t>> parent;
  std::vector<std::size_t> parents_first;
  /// From the file's axes to marey's world: the half turn of a VRM 0.x.
  glm::dquat world_from_file{1.0, 0.0, 0.0, 0.0};
};

/// World transform of every node, scale included, and its rotation alone.
struct PlacedNodes {
  std::vector<glm::dmat4> world_from_node;
  std::vector<glm::dquat> rotation;
};
[[nodiscard]] PlacedNodes place_nodes(const NodeTree& tree,
                                      std::span<const NodePose> poses);
/// Checks that the node's position is finite and within kMaxDistance_m, and its rotation
/// finite.
[[nodiscard]] bool is_near(const PlacedNodes& placed, std::size_t node);

/// A skeleton and the nodes of its joints.
struct NodeSkeleton {
  Skeleton skeleton;
  std::vector<std::size_t> node_of_joint;
  std::vector<std::optional<JointIndex>> joint_of_node;  ///< One per node.
};

/// A model with its name in error messages.
struct NamedModel {
  const tinygltf::Model& model;
  std::string file;

  [[nodiscard]] Error fail(std::string cause) const;
};

/// Returns the bone of each node, from the first humanoid extension, else from the names.
/// Sets `faces_back` for a VRM 0.x, whose bodies face -Z.
[[nodiscard]] std::map<std::size_t, HumanBone> bones_of(const tinygltf::Model& model,
                                                        bool& faces_back);

/// Builds Character::skeleton. Errors: those of read_character().
[[nodiscard]] Result<NodeSkeleton> skeleton_of(
    const NamedModel& file,
    const NodeTree& tree,
    const std::map<std::size_t, HumanBone>& bones);

/// Returns the nodes' poses in the bind pose of the skins. nullopt if this is the rest
/// pose (to 5 degrees), or if no placement of the skin in the world gives its bones the
/// lengths of the nodes.
[[nodiscard]] Result<std::optional<std::vector<NodePose>>> bound_poses(
    const NamedModel& file, const NodeTree& tree, const NodeSkeleton& body);

/// Returns the numbers of an accessor, row after row, `components` each; normalized
/// integers as fractions. Checks that they lie within their buffer.
[[nodiscard]] Result<std::vector<double>> accessor_values(const NamedModel& file,
                                                          int accessor,
                                                          std::size_t components);

/// Returns all skinned triangles in the rest pose; nullopt if there are none.
[[nodiscard]] Result<std::optional<SkinnedMesh>> read_skinned_mesh(
    const NamedModel& file, const NodeTree& tree, const NodeSkeleton& body);

/// The vertices of one skinned mesh in their bind pose.
struct BoundSkin {
  std::vector<glm::dmat4> joint_from_bound;  ///< One per joint of the skin.
  /// One per joint of the skin: its joint in the body's skeleton.
  std::vector<JointIndex> joints;
  std::vector<glm::dvec3> p_in_bound;
  /// Per vertex: weights, which sum to 1, and indices into `joints`.
  std::vector<std::array<std::pair<double, std::size_t>, 4>> carriers;
};
/// Reads the vertices of all skinned meshes. Errors: those of read_skinned_mesh().
[[nodiscard]] Result<std::vector<BoundSkin>> read_bound_skins(const NamedModel& file,
                                                              const NodeSkeleton& body);

/// Parses the bytes of a file into a model, its nodes and its skeleton with the bones.
/// Errors: those of read_character().
[[nodiscard]] Status load_nodes(const std::string& bytes,
                                const std::filesystem::path& path,
                                tinygltf::Model& model,
                                NodeTree& tree,
                                NodeSkeleton& body);

/// Receives world_from_joint of all joints of one frame, scale included.
using EachFrame = std::function<void(std::span<const glm::dmat4> world_from_joint)>;

/// The first animation, as in Character; no motion if there is none.
struct ReadAnimation {
  std::optional<Motion> motion;
  double ignored_translation_m = 0.0;
  std::vector<std::string> names;  ///< Character::animations.
};
[[nodiscard]] Result<ReadAnimation> read_animation(const NamedModel& file,
                                                   const NodeTree& tree,
                                                   const NodeSkeleton& body,
                                                   const EachFrame& each = {});

}  // namespace marey::recordings
