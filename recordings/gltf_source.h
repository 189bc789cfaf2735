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

#include "core/result.h"
#include "recordings/gltf.h"
#include "recordings/gltf_builder.h"

namespace marey::recordings {

/// A joint's node at rest.
struct NodeOfJoint {
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< Local.
  glm::dvec3 translation{0.0};              ///< Local, in the file's unit.
  double world_scale = 1.0;                 ///< Of the node's frame, own scale included.
  /// The joint that is the node's parent. nullopt: the parent is no joint.
  std::optional<std::size_t> parent_joint;
  glm::dmat4 world_from_parent{1.0};  ///< Of the node's parent, marey's world included.
  glm::dquat parent_rotation{1.0, 0.0, 0.0, 0.0};  ///< The rotations in it.
};

/// A glTF asset as it is in its file, and what marey makes of it.
struct GltfSource {
  std::string json;
  std::vector<std::string> buffers;  ///< Bytes of each of the json's buffers.
  std::vector<std::string> images;   ///< Bytes of each image; empty if not loaded.
  Character character;
  std::vector<int> node_of_joint;
  /// Of the node above the root joint at rest, marey's world included; identity if none.
  glm::dmat4 world_from_root_parent{1.0};
  /// The rotations in it.
  glm::dquat world_from_root_parent_rotation{1.0, 0.0, 0.0, 0.0};
  std::vector<NodeOfJoint> nodes;                  ///< One per joint.
  glm::dquat world_from_file{1.0, 0.0, 0.0, 0.0};  ///< The half turn of a VRM 0.x.
};

/// See read_character().
[[nodiscard]] Result<GltfSource> read_gltf_source(const std::filesystem::path& path);
/// See parse_character().
[[nodiscard]] Result<GltfSource> parse_gltf_source(const std::string& bytes,
                                                   const std::filesystem::path& path);

/// Whether a motion's joints can be written as they are: each on the joint that is its
/// node's parent. Else tracks_against_nodes() tells them.
[[nodiscard]] bool hangs_as_nodes(const GltfSource& source, const ChangedFrame& changed);

/// The motion of a body as `changed` says in the terms of the source's nodes, whatever
/// the body's joints hang on: by their places in the world.
[[nodiscard]] std::vector<NodeTrack> tracks_against_nodes(const GltfSource& source,
                                                          const Motion& motion,
                                                          const ChangedFrame& changed);

/// The nodes of a body that rests as its skin was bound rest so in the document, too, as
/// source.nodes does then.
void rest_nodes_as_bound(const Skeleton& body,
                         const ChangedFrame& changed,
                         GltfSource& source,
                         Json& document);

/// Puts a node above the roots of each scene that turns them.
void turn_scenes(Json& document, const glm::dquat& turn);

}  // namespace marey::recordings
