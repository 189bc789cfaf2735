// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

#include "core/result.h"
#include "recordings/gltf.h"

namespace marey::recordings {

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
};

/// See read_character().
[[nodiscard]] Result<GltfSource> read_gltf_source(const std::filesystem::path& path);
/// See parse_character().
[[nodiscard]] Result<GltfSource> parse_gltf_source(const std::string& bytes,
                                                   const std::filesystem::path& path);

}  // namespace marey::recordings
