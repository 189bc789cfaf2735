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

/// The posture of a motion's skeleton from which all turns are counted.
enum class NeutralKind {
  kAuto,   ///< The file's rest where it stands, else kNamed or kTPose.
  kRest,   ///< The file's rest.
  kTPose,  ///< A T-pose by the geometry of the bones.
  kFrame,  ///< A frame of the motion.
  kFile,   ///< The rest, or else the first frame, of another file of the skeleton.
  kNamed,  ///< The T-pose of a skeleton that marey knows.
};

struct Neutral {
  NeutralKind kind = NeutralKind::kAuto;
  int frame = 0;  ///< Of kFrame, from 0.
  std::filesystem::path file;
  const retarget::NamedNeutral* named = nullptr;
};

/// "rest", "t-pose", "frame 12", "file", "bandai".
[[nodiscard]] std::string name(NeutralKind kind);

/// Reads "auto", "rest", "t-pose", "frame:N", a name of retarget::named_neutrals(), or
/// the path of a .bvh, .amc, .glb, .gltf, .vrm or .vrma file. Errors: none of these, with
/// what there is; a frame that is no number.
[[nodiscard]] Result<Neutral> read_neutral(const std::string& word);

/// Gives a motion its neutral: makes it the rest of its skeleton. The kind that was taken
/// of kAuto. A body without poses keeps its rest. `up_in_file` is where up is in the
/// file's world; nullopt: retarget::up_of_motion(). Errors (bad input): a rest, frame or
/// file in which the body does not stand; a frame that the motion does not have; a file
/// that cannot be read or is of another skeleton.
[[nodiscard]] Result<NeutralKind> set_neutral(
    const Neutral& neutral,
    const retarget::FoundBones& found,
    Motion& motion,
    const std::optional<glm::dvec3>& up_in_file = {});

/// For command lines: what is wrong with the word; empty when nothing is.
[[nodiscard]] std::string neutral_mistake(const std::string& word);

/// Help of --neutral.
inline constexpr const char* kNeutralHelp =
    "From which posture the motion's turns are counted: auto (the file's rest where it "
    "stands, else a T-pose by its bones), rest, t-pose, frame:N (from 0), a file of the "
    "same skeleton, bandai or iclone";

}  // namespace marey::app
