// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/motion.h"
#include "retarget/bones/identify_bones.h"
#include "retarget/bones/neutral_t_pose.h"

namespace marey::app {

/// The posture of a motion's skeleton relative to which all rotations are counted.
enum class NeutralKind {
  kAuto,   ///< The file's rest if the body stands in it, else kNamed or kTPose.
  kRest,   ///< The file's rest.
  kTPose,  ///< A T-pose computed from the geometry of the bones.
  kFrame,  ///< A frame of the motion.
  kFile,   ///< The rest, else the first frame, of another file of the same skeleton.
  kNamed,  ///< The T-pose of a known skeleton.
};

struct Neutral {
  NeutralKind kind = NeutralKind::kAuto;
  int frame = 0;  ///< Frame of kFrame, from 0.
  std::filesystem::path file;
  const retarget::NamedNeutral* named = nullptr;
};

/// Returns the kind's name: "rest", "t-pose", "frame", "file", "named".
[[nodiscard]] std::string name(NeutralKind kind);

/// Parses "auto", "rest", "t-pose", "frame:N", a name of retarget::named_neutrals(), or
/// the path of a .bvh, .amc, .glb, .gltf, .vrm or .vrma file. Errors: another word, with
/// the list of valid ones; a frame that is not a number.
[[nodiscard]] Result<Neutral> read_neutral(const std::string& word);

/// Makes the neutral the rest of the motion's skeleton. Returns the kind, resolved for
/// kAuto. A body without poses keeps its rest. `up_in_file` is the up direction in the
/// file's world; nullopt: retarget::up_of_motion(). Errors (bad input): a rest, frame or
/// file in which the body does not stand; a frame outside the motion; a file that cannot
/// be read or is of another skeleton.
[[nodiscard]] Result<NeutralKind> set_neutral(
    const Neutral& neutral,
    const retarget::FoundBones& found,
    Motion& motion,
    const std::optional<glm::dvec3>& up_in_file = {});

/// Validates the word for command lines. Returns the fault; empty: none.
[[nodiscard]] std::string neutral_mistake(const std::string& word);

/// Help text of --neutral.
inline constexpr const char* kNeutralHelp =
    "Posture from which the motion's rotations are counted: auto (the file's rest if the "
    "body stands in it, else a T-pose from its bones), rest, t-pose, frame:N (from 0), a "
    "file of the same skeleton, bandai or iclone";

}  // namespace marey::app
