// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

#include "core/base/result.h"
#include "recordings/gltf/gltf.h"
#include "recordings/gltf/gltf_builder.h"

namespace marey::recordings {

/// A joint's node at rest.
struct NodeOfJoint {
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< Local.
  glm::dvec3 translation{0.0};              ///< Local, in the file's unit.
  /// Scale of the node's world frame, own scale included.
  double world_scale = 1.0;
  /// The joint of the node's parent. nullopt: the parent is no joint.
  std::optional<std::size_t> parent_joint;
  /// World transform of the node's parent, in marey's world.
  glm::dmat4 world_from_parent{1.0};
  glm::dquat parent_rotation{1.0, 0.0, 0.0, 0.0};  ///< Its rotation.
};

/// A glTF asset: the content of its file and the character read from it.
struct GltfSource {
  std::string json;
  std::vector<std::string> buffers;  ///< Bytes of each of the json's buffers.
  std::vector<std::string> images;   ///< Bytes of each image; empty if not loaded.
  Character character;
  std::vector<int> node_of_joint;
  /// World transform of the node above the root joint at rest, in marey's world; identity
  /// if none.
  glm::dmat4 world_from_root_parent{1.0};
  /// Its rotation.
  glm::dquat world_from_root_parent_rotation{1.0, 0.0, 0.0, 0.0};
  std::vector<NodeOfJoint> nodes;                  ///< One per joint.
  glm::dquat world_from_file{1.0, 0.0, 0.0, 0.0};  ///< The half turn of a VRM 0.x.
};

/// Reads an asset like read_character().
[[nodiscard]] Result<GltfSource> read_gltf_source(const std::filesystem::path& path);
/// Parses an asset like parse_character().
[[nodiscard]] Result<GltfSource> parse_gltf_source(
    const std::string& bytes,
    const std::filesystem::path& path,
    const ReadCharacterOptions& options = {});

/// Returns true if a motion's joint rotations can be written directly, because each
/// joint's parent is the joint of its node's parent. Otherwise use
/// tracks_against_nodes().
[[nodiscard]] bool matches_node_hierarchy(const GltfSource& source,
                                          const ChangedFrame& changed);

/// Converts the motion of a body described by `changed` to keys of the source's nodes,
/// from the joints' world transforms. The body's hierarchy may differ from the nodes'.
[[nodiscard]] std::vector<NodeTrack> tracks_against_nodes(const GltfSource& source,
                                                          const Motion& motion,
                                                          const ChangedFrame& changed);

/// Sets the rest pose of the nodes, in the document and in source.nodes, to the bind pose
/// of the body's skin.
void set_bind_pose_as_rest(const Skeleton& body,
                           const ChangedFrame& changed,
                           GltfSource& source,
                           Json& document);

/// Adds a node with rotation `turn` above the roots of each scene.
void turn_scenes(Json& document, const glm::dquat& turn);

}  // namespace marey::recordings
