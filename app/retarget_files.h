// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/motion.h"
#include "core/result.h"
#include "core/skeleton.h"
#include "retarget/retarget_motion.h"

namespace marey::app {

struct RetargetedFiles {
  retarget::RetargetedMotion retargeted;
  std::vector<std::filesystem::path> files;
};

/// Puts a motion on an avatar and writes it beside each other as STEM.bvh and, if the
/// avatar is a GLB, VRM or glTF, as STEM.glb with the avatar's own look. `stem` is a path
/// without an extension, which may hold dots.
/// Errors: the avatar cannot be read; it lacks bones; the disk.
[[nodiscard]] Result<RetargetedFiles> retarget_to_files(
    const Motion& motion,
    const std::filesystem::path& avatar,
    const std::filesystem::path& stem);

/// Only the file that `out`'s extension names: .bvh or .glb.
[[nodiscard]] Result<RetargetedFiles> retarget_to_file(
    const Motion& motion,
    const std::filesystem::path& avatar,
    const std::filesystem::path& out);

/// Whether a motion can be put on this body: it can be read and has the bones. Costs what
/// reading does. Errors: those of retarget_to_files() that are the avatar's.
[[nodiscard]] Status check_avatar(const std::filesystem::path& avatar);

/// The skeleton in a .bvh, .glb, .gltf, .vrm or .vrma file.
/// Errors: unreadable; another kind of file.
[[nodiscard]] Result<Skeleton> read_skeleton(const std::filesystem::path& path);

/// Whether the file is a .glb, .gltf, .vrm or .vrma by its name.
[[nodiscard]] bool is_gltf(const std::filesystem::path& path);

struct ReadMotion {
  Motion motion;
  /// The largest movement of a bone against its parent that was left out. [m]
  double ignored_translation_m = 0.0;
};

/// What a user should know of movement that was left out, if it can be seen.
[[nodiscard]] std::optional<std::string> left_out(const ReadMotion& read);

/// The motion in a .bvh, .glb, .gltf, .vrm or .vrma file.
/// Errors: unreadable; another kind of file; a file without a motion.
[[nodiscard]] Result<ReadMotion> read_motion(const std::filesystem::path& path);

}  // namespace marey::app
