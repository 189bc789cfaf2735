// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/motion/neutral.h"
#include "app/motion/raw_body.h"
#include "core/base/result.h"
#include "core/bone_map.h"
#include "core/motion.h"
#include "recordings/gltf/gltf.h"
#include "recordings/text/mesh.h"
#include "retarget/body/body_volume.h"
#include "retarget/body/find_soles.h"
#include "retarget/body/skin.h"
#include "retarget/bones/body_frame.h"
#include "retarget/bones/exchanged_sides.h"
#include "retarget/bones/identify_bones.h"
#include "retarget/bones/up_of_motion.h"

namespace marey::app {

/// A body's file, and the bone map that counts for it. Without one given, the one that
/// stands beside the file (man.bones.toml beside man.glb) counts, if there is one.
struct BodyFile {
  // Implicit on purpose: most bodies have no map but the one beside them.
  // NOLINTNEXTLINE(google-explicit-constructor)
  BodyFile(std::filesystem::path file,
           std::optional<std::filesystem::path> map = std::nullopt)
      : path(std::move(file)), bone_map(std::move(map)) {}

  std::filesystem::path path;
  std::optional<std::filesystem::path> bone_map;
  std::optional<Neutral> neutral = std::nullopt;  ///< Of a file with a motion.
};

/// A body that stands as marey's do: Y up, facing +Z, in metres, its bones marked.
struct ReadBody {
  RawBody raw;  ///< Its motion and skeleton in marey's frame.
  retarget::FoundBones bones;
  retarget::BodyFrame frame;
  std::optional<std::filesystem::path> bone_map;  ///< That counted.
  NeutralKind neutral = NeutralKind::kRest;  ///< What the rest is.
  bool file_rest_stands = false;             ///< Of a file with a motion.
  /// Where up is, of a motion whose rest does not stand and whose bone map does not say.
  std::optional<retarget::MotionUp> guessed_up;
  /// Of a file with a motion: what of it bears the other side's names.
  retarget::ExchangedSides exchanged = retarget::ExchangedSides::kNone;
  /// The joints hang otherwise than in the file: recordings::ChangedFrame's.
  std::vector<std::optional<JointIndex>> read_joint;
  bool rests_as_bound = false;  ///< As its skin was bound, not as its nodes rest.
  retarget::Soles soles;  ///< By its skin, in marey's frame.
  /// What it takes up of space, by its skin; nullopt: nobody knows.
  std::optional<retarget::BodyVolume> volume;
  retarget::Skin skin;  ///< In marey's frame; empty: none, or no body to hang it on.

  [[nodiscard]] const Skeleton& skeleton() const { return raw.motion.skeleton; }
  /// What write_retargeted() has to know.
  [[nodiscard]] recordings::ChangedFrame changed() const {
    return {frame.marey_from_file, frame.scale, read_joint, rests_as_bound, true};
  }
  /// What was assumed of it, and which bones a user should look at.
  [[nodiscard]] std::vector<std::string> remarks() const;
};

/// Tells the bones of a body and how it stands, and puts it into marey's frame: the one
/// place that does.
/// A motion without a rest that stands gets a T-pose by its geometry, or the neutral that
/// `file` names. A body whose nodes rest less alike on its two sides than its skin was
/// bound rests as that was.
/// Errors, naming the file: those of identify_bones(), hang_bones(), set_neutral() and
/// find_body_frame(), of reading the bone map.
[[nodiscard]] Result<ReadBody> identify_body(RawBody raw, const BodyFile& file);

/// The error (kQuality) of a motion whose left and right are exchanged, with the way to
/// correct it; nullopt: they are not. `path` is the motion's, `map_option` the command
/// line's option for its bone map.
[[nodiscard]] std::optional<Error> exchanged_sides_error(
    const std::filesystem::path& path,
    retarget::ExchangedSides exchanged,
    const std::string& map_option);

/// identify_body() of read_raw_body().
[[nodiscard]] Result<ReadBody> read_body(const BodyFile& file);

}  // namespace marey::app
