// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/read_body.h"
#include "core/motion.h"
#include "core/result.h"
#include "core/skeleton.h"
#include "retarget/retarget_motion.h"

namespace marey::app {

struct RetargetedFiles {
  retarget::RetargetedMotion retargeted;
  std::vector<std::filesystem::path> files;
  std::vector<std::string> remarks = {};  ///< ReadBody::remarks() of the avatar.
};

/// Puts a motion on an avatar and writes it beside each other as STEM.bvh and, if the
/// avatar is a GLB, VRM or glTF, as STEM.glb with the avatar's own look. `stem` is a path
/// without an extension, which may hold dots.
/// Errors: read_body()'s, of the avatar; the disk.
[[nodiscard]] Result<RetargetedFiles> retarget_to_files(
    const Motion& motion, const BodyFile& avatar, const std::filesystem::path& stem);

/// Only the file that `out`'s extension names: .bvh or .glb.
[[nodiscard]] Result<RetargetedFiles> retarget_to_file(const Motion& motion,
                                                       const BodyFile& avatar,
                                                       const std::filesystem::path& out);

/// Whether a motion can be put on this body: it can be read and has the bones. Costs what
/// reading does. Errors: those of retarget_to_files() that are the avatar's.
[[nodiscard]] Status check_avatar(const BodyFile& avatar);

/// The skeleton in a .bvh, .glb, .gltf, .vrm or .vrma file, its bones told, as
/// read_body() gives it. Errors: read_body()'s.
[[nodiscard]] Result<Skeleton> read_skeleton(const BodyFile& file);

struct ReadMotion {
  Motion motion;
  /// The largest movement of a bone against its parent that was left out. [m]
  double ignored_translation_m = 0.0;
  std::vector<std::string> remarks = {};  ///< ReadBody::remarks().
};

/// What a user should know of movement that was left out, if it can be seen.
[[nodiscard]] std::optional<std::string> left_out(const ReadMotion& read);

/// The motion in a .bvh, .glb, .gltf, .vrm or .vrma file, its bones told, as read_body()
/// gives it. Errors: read_body()'s; a file without a motion.
[[nodiscard]] Result<ReadMotion> read_motion(const BodyFile& file);

}  // namespace marey::app
