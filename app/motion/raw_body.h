// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/motion.h"
#include "recordings/body/mesh.h"
#include "recordings/gltf/gltf.h"
#include "retarget/bones/body_frame.h"

namespace marey::app {

/// Returns true if the file's extension is .glb, .gltf, .vrm or .vrma.
[[nodiscard]] bool is_gltf(const std::filesystem::path& path);

/// Returns the extensions of all files that read_raw_body() reads, for help and messages:
/// ".bvh, .amc, .npz, .glb, .gltf, .vrm or .vrma".
[[nodiscard]] std::string body_extensions();
/// Returns true if the file's extension is one of body_extensions().
[[nodiscard]] bool is_body_file(const std::filesystem::path& path);

/// The content of a .bvh, .amc (with its .asf in the same folder), .npz, .glb, .gltf,
/// .vrm or .vrma file, in the file's own frame.
struct RawBody {
  Motion motion;  ///< Without poses if the file has no motion.
  bool has_motion = false;
  /// Largest translation of a bone relative to its parent that was ignored. [m]
  double ignored_translation_m = 0.0;
  bool rate_is_guessed = false;         ///< The file states no rate.
  std::vector<std::string> animations;  ///< glTF: as recordings::Character's.
  /// Uncertainty, [frame][joint]; empty: not in the file.
  std::vector<std::vector<JointUncertainty>> uncertainty;
  std::optional<recordings::SkinnedMesh> mesh;
  retarget::FileUnit unit;
  std::vector<int> node_of_joint;              ///< glTF: as recordings::Character's.
  bool faces_back = false;                     ///< As recordings::Character's.
  std::vector<bool> carries_skin;              ///< As recordings::Character's.
  std::optional<recordings::BoundBody> bound;  ///< As recordings::Character's.
};

/// Reads a body file. `animation` is the index of a glTF's animation. Errors: unreadable;
/// another kind of file; an .amc without its .asf.
[[nodiscard]] Result<RawBody> read_raw_body(const std::filesystem::path& path,
                                            std::size_t animation = 0);

}  // namespace marey::app
