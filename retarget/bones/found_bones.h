// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/ids.h"
#include "core/humanoid.h"

namespace marey::retarget {

/// Reason why a joint is identified as a bone.
enum class BoneEvidence : unsigned char {
  kFile,   ///< Stated by the file's humanoid data.
  kUser,   ///< Set by the user.
  kName,   ///< Has the bone's name in the scheme that explains most names.
  kChain,  ///< Its position in the tree follows from named bones.
  kShape,  ///< Only the tree and the lengths of the body.
};

/// Returns the word for reports: "file", "told" for kUser, "name", "chain" or
/// "shape".
[[nodiscard]] std::string_view name(BoneEvidence evidence);

struct FoundBone {
  JointIndex joint{};
  BoneEvidence evidence = BoneEvidence::kName;
  /// 1 is certain; below 0.5 the user should check.
  double confidence = 1.0;
};

/// Assignment of joints to bones. Depends on the tree alone, not on posture, unit or
/// direction.
struct FoundBones {
  std::array<std::optional<FoundBone>, kHumanBoneCount> bones{};
  std::string scheme;                ///< "VRM", "Mixamo", "no names".
  std::vector<std::string> remarks;  ///< Notes for the user, one sentence each.

  [[nodiscard]] std::optional<JointIndex> joint(HumanBone bone) const {
    const auto& found = bones[index(bone)];
    return found ? std::optional(found->joint) : std::nullopt;
  }
};

}  // namespace marey::retarget
