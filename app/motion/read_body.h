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
#include "core/finding.h"
#include "core/motion.h"
#include "recordings/body/mesh.h"
#include "recordings/gltf/gltf.h"
#include "retarget/body/body_volume.h"
#include "retarget/body/find_soles.h"
#include "retarget/body/skin.h"
#include "retarget/bones/body_frame.h"
#include "retarget/bones/exchanged_sides.h"
#include "retarget/bones/identify_bones.h"
#include "retarget/bones/up_of_motion.h"

namespace marey::app {

/// A body's file and its bone map. If no map is given, the file NAME.bones.toml in the
/// same folder is used if it exists (man.bones.toml for man.glb).
struct BodyFile {
  // Implicit on purpose: most bodies have no map other than that in their folder.
  // NOLINTNEXTLINE(google-explicit-constructor)
  BodyFile(std::filesystem::path file,
           std::optional<std::filesystem::path> map = std::nullopt)
      : path(std::move(file)), bone_map(std::move(map)) {}

  std::filesystem::path path;
  std::optional<std::filesystem::path> bone_map;
  std::optional<Neutral> neutral = std::nullopt;  ///< For a file with a motion.
  std::size_t animation = 0;                      ///< Index of a glTF's animation.
};

/// A body in marey's frame: Y up, facing +Z, in metres, its bones marked.
struct ReadBody {
  RawBody raw;  ///< Its motion and skeleton in marey's frame.
  retarget::FoundBones bones;
  retarget::BodyFrame frame;
  std::optional<std::filesystem::path> bone_map;  ///< The bone map used.
  NeutralKind neutral = NeutralKind::kRest;       ///< Kind of the skeleton's rest.
  bool file_rest_stands = false;                  ///< For a file with a motion.
  /// Estimated up direction, if the body does not stand in its rest and the bone map does
  /// not state it.
  std::optional<retarget::MotionUp> guessed_up;
  /// For a file with a motion: the limbs whose left and right names are exchanged.
  retarget::ExchangedSides exchanged = retarget::ExchangedSides::kNone;
  /// Set if joints have other parents than in the file: recordings::ChangedFrame's.
  std::vector<std::optional<JointIndex>> read_joint;
  bool rests_as_bound = false;  ///< The rest is the skin's bind pose, not the nodes'.
  retarget::Soles soles;        ///< Measured from the skin, in marey's frame.
  /// Volume of the body, measured from the skin; nullopt: unknown.
  std::optional<retarget::BodyVolume> volume;
  retarget::Skin skin;  ///< In marey's frame; empty: no skin, or no mapped body.

  [[nodiscard]] const Skeleton& skeleton() const { return raw.motion.skeleton; }
  /// Returns the changes to the file's frame, for write_retargeted().
  [[nodiscard]] recordings::ChangedFrame changed() const {
    return {frame.marey_from_file, frame.scale, read_joint, rests_as_bound, true};
  }
  /// Returns the assumptions made, and the uncertain bones that a user should check.
  [[nodiscard]] std::vector<std::string> remarks() const;
};

/// Identifies the bones of a body and its standing posture, and converts it to marey's
/// frame. Only this function does so.
/// If the body does not stand in the rest of its motion, it gets a T-pose computed from
/// its geometry, or the neutral of `file`. If the rest of the nodes is less symmetric
/// than the skin's bind pose, the bind pose becomes the rest.
/// Errors, with the file: those of identify_bones(), reparent_to_carriers(),
/// set_neutral(), find_body_frame() and of reading the bone map.
[[nodiscard]] Result<ReadBody> identify_body(RawBody raw, const BodyFile& file);

/// Returns a poor finding for a motion whose left and right are exchanged, with the
/// correction; nullopt: they are not exchanged. `path` is the motion's file, `map_option`
/// the command-line option for its bone map.
[[nodiscard]] std::optional<Finding> assess_exchanged_sides(
    const std::filesystem::path& path,
    retarget::ExchangedSides exchanged,
    const std::string& map_option);

/// Calls identify_body() with the result of read_raw_body().
[[nodiscard]] Result<ReadBody> read_body(const BodyFile& file);

}  // namespace marey::app
