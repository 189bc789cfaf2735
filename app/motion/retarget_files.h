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

/// An avatar that was read, ready for retargeting.
struct OpenedAvatar {
  std::filesystem::path file;
  Skeleton skeleton;                           ///< In marey's frame, its bones marked.
  BodyLook look;                               ///< Without a file if there is no mesh.
  retarget::Soles soles;                       ///< ReadBody::soles.
  std::optional<retarget::BodyVolume> volume;  ///< ReadBody::volume.
  retarget::Skin skin;                         ///< ReadBody::skin.
  std::vector<std::string> remarks;            ///< ReadBody::remarks().
  /// The file is a VRM 0.x: `skeleton` was rotated by half a turn about Y.
  bool file_faces_back = false;
};

/// Reads an avatar. Errors (kBadInput), with the file: read_body()'s, map_body()'s.
[[nodiscard]] Result<OpenedAvatar> open_avatar(const BodyFile& avatar);

struct RetargetedFiles {
  retarget::RetargetedMotion retargeted;
  std::vector<std::filesystem::path> files;
  std::vector<std::string> remarks = {};  ///< ReadBody::remarks() of the avatar.
  AvatarVerdict verdict = {};
};

/// Retargets a motion to an avatar and writes the results. The avatar's soles are used,
/// and its skin for the contacts of hands with the body (RetargetOptions::hands). Writes
/// STEM.bvh; for a GLB, VRM or glTF also STEM.glb with the avatar's mesh; for an avatar
/// with the bones of VRM's humanoid also STEM.vrma. `stem` is a path without an
/// extension, which may contain dots.
/// Errors: open_avatar()'s; the disk.
[[nodiscard]] Result<RetargetedFiles> retarget_to_files(
    const Motion& motion, const BodyFile& avatar, const std::filesystem::path& stem);

/// Checks that a motion can be put on this body: it can be read and has the needed bones.
/// Cost: that of reading the body. Errors: open_avatar()'s.
[[nodiscard]] Status check_avatar(const BodyFile& avatar);

/// Reads the skeleton of a .bvh, .glb, .gltf, .vrm or .vrma file. Its bones are
/// identified by read_body(). Errors: read_body()'s.
[[nodiscard]] Result<Skeleton> read_skeleton(const BodyFile& file);

struct ReadMotion {
  Motion motion;
  /// Largest translation of a bone relative to its parent that was ignored. [m]
  double ignored_translation_m = 0.0;
  std::vector<std::string> remarks = {};  ///< ReadBody::remarks().
  retarget::ExchangedSides exchanged = retarget::ExchangedSides::kNone;  ///< ReadBody's.
  bool rate_is_guessed = false;  ///< The file states no rate.
  /// Uncertainty, [frame][joint]; empty: not in the file.
  std::vector<std::vector<JointUncertainty>> uncertainty = {};
  std::vector<std::string> animations = {};  ///< glTF: names of all animations.
};

/// Returns a remark on ignored bone translation, if it is large enough to be visible.
[[nodiscard]] std::optional<std::string> left_out(const ReadMotion& read);

/// Reads the motion of a .bvh, .amc, .npz, .glb, .gltf, .vrm or .vrma file. Its bones are
/// identified by read_body(). Errors: read_body()'s; a file without a motion.
[[nodiscard]] Result<ReadMotion> read_motion(const BodyFile& file);

}  // namespace marey::app
