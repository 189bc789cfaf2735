// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/base/result.h"
#include "core/motion.h"
#include "recordings/gltf/gltf.h"
#include "recordings/text/mesh.h"
#include "retarget/bones/body_frame.h"

namespace marey::app {

/// Whether the file is a .glb, .gltf, .vrm or .vrma by its name.
[[nodiscard]] bool is_gltf(const std::filesystem::path& path);

/// What a .bvh, .amc (its .asf beside it), .glb, .gltf, .vrm or .vrma file holds, in its
/// own frame.
struct RawBody {
  Motion motion;  ///< Without poses when the file holds no motion.
  bool has_motion = false;
  /// The largest movement of a bone against its parent that was left out. [m]
  double ignored_translation_m = 0.0;
  std::optional<recordings::SkinnedMesh> mesh;
  retarget::FileUnit unit;
  std::vector<int> node_of_joint;              ///< Of glTF: recordings::Character's.
  bool faces_back = false;                     ///< Likewise.
  std::vector<bool> carries_skin;              ///< Likewise.
  std::optional<recordings::BoundBody> bound;  ///< Likewise.
};

/// Errors: unreadable; another kind of file; an .amc without its .asf.
[[nodiscard]] Result<RawBody> read_raw_body(const std::filesystem::path& path);

}  // namespace marey::app
