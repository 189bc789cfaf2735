// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/motion.h"
#include "core/result.h"
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

/// The motion in a .bvh, .glb, .gltf, .vrm or .vrma file.
/// Errors: unreadable; another kind of file; a file without a motion.
[[nodiscard]] Result<Motion> read_motion(const std::filesystem::path& path);

}  // namespace marey::app
