// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/motion/assess_avatar.h"
#include "app/motion/motion_files.h"
#include "app/motion/read_body.h"
#include "core/base/result.h"
#include "core/motion.h"
#include "core/skeleton.h"
#include "retarget/body/body_volume.h"
#include "retarget/body/find_soles.h"
#include "retarget/body/skin.h"
#include "retarget/motion/retarget_motion.h"

namespace marey::app {

/// A body that motions can be put on.
struct OpenedAvatar {
  std::filesystem::path file;
  Skeleton skeleton;                 ///< In marey's frame, its bones marked.
  BodyLook look;                     ///< Without a file when there is no mesh.
  retarget::Soles soles;             ///< ReadBody::soles.
  std::optional<retarget::BodyVolume> volume;  ///< ReadBody::volume.
  retarget::Skin skin;                         ///< ReadBody::skin.
  std::vector<std::string> remarks;  ///< ReadBody::remarks().
  /// The file is a VRM 0.x: `skeleton` was turned half about Y.
  bool file_faces_back = false;
};

/// Reads an avatar. Errors (kBadInput), naming the file: read_body()'s, map_body()'s.
[[nodiscard]] Result<OpenedAvatar> open_avatar(const BodyFile& avatar);

struct RetargetedFiles {
  retarget::RetargetedMotion retargeted;
  std::vector<std::filesystem::path> files;
  std::vector<std::string> remarks = {};  ///< ReadBody::remarks() of the avatar.
  AvatarVerdict verdict = {};
};

/// Puts a motion on an avatar, with its soles, and with what hands do to the body
/// (RetargetOptions::hands) by the avatar's skin, and writes it beside each other as STEM.bvh; if the avatar
/// is a GLB, VRM or glTF, as STEM.glb with its own look; and if it has the bones of VRM's
/// humanoid, as STEM.vrma. `stem` is a path without an extension, which may hold dots.
/// Errors: open_avatar()'s; the disk.
[[nodiscard]] Result<RetargetedFiles> retarget_to_files(
    const Motion& motion, const BodyFile& avatar, const std::filesystem::path& stem);

/// Whether a motion can be put on this body: it can be read and has the bones. Costs what
/// reading does. Errors: open_avatar()'s.
[[nodiscard]] Status check_avatar(const BodyFile& avatar);

/// The skeleton in a .bvh, .glb, .gltf, .vrm or .vrma file, its bones told, as
/// read_body() gives it. Errors: read_body()'s.
[[nodiscard]] Result<Skeleton> read_skeleton(const BodyFile& file);

struct ReadMotion {
  Motion motion;
  /// The largest movement of a bone against its parent that was left out. [m]
  double ignored_translation_m = 0.0;
  std::vector<std::string> remarks = {};  ///< ReadBody::remarks().
  retarget::ExchangedSides exchanged = retarget::ExchangedSides::kNone;  ///< ReadBody's.
};

/// What a user should know of movement that was left out, if it can be seen.
[[nodiscard]] std::optional<std::string> left_out(const ReadMotion& read);

/// The motion in a .bvh, .glb, .gltf, .vrm or .vrma file, its bones told, as read_body()
/// gives it. Errors: read_body()'s; a file without a motion.
[[nodiscard]] Result<ReadMotion> read_motion(const BodyFile& file);

}  // namespace marey::app
