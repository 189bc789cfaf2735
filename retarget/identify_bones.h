// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/bone_map.h"
#include "core/humanoid.h"
#include "core/ids.h"
#include "core/result.h"
#include "core/skeleton.h"

namespace marey::retarget {

/// Why a joint is taken for a bone.
enum class BoneEvidence : unsigned char {
  kFile,   ///< The file's humanoid data says so.
  kTold,   ///< The user says so.
  kName,   ///< It bears the bone's name in the scheme that most names follow.
  kChain,  ///< It stands where the bone must be between or beside named ones.
  kShape,  ///< Nothing but the tree and the lengths of the body.
};

/// "file", "told", "name", "chain", "shape".
[[nodiscard]] std::string_view name(BoneEvidence evidence);

struct FoundBone {
  JointIndex joint{};
  BoneEvidence evidence = BoneEvidence::kName;
  /// 1 is certain; below 0.5 a user should look.
  double confidence = 1.0;
};

/// Which joint is which bone. Facts of the tree alone: no posture, unit or direction.
struct FoundBones {
  std::array<std::optional<FoundBone>, kHumanBoneCount> bones{};
  std::string scheme;                ///< "VRM", "Mixamo", "no names".
  std::vector<std::string> remarks;  ///< What a user should know, a sentence each.

  [[nodiscard]] std::optional<JointIndex> joint(HumanBone bone) const {
    const auto& found = bones[index(bone)];
    return found ? std::optional(found->joint) : std::nullopt;
  }
};

/// Tells which joint of a skeleton is which bone.
///
/// Marks that are there (Joint::bone) are kept when hips and both legs have theirs, and
/// are all there is then. What `told` says comes before them. Else names are read: the
/// scheme that explains most of the legs and then of all bones, whatever is around a name
/// (namespaces, sides before or behind, capitals, separators). Without names that explain
/// both legs, the shape decides: a joint from which two like branches go, the legs, and
/// one above it from which two others go, the arms, and mostly a head.
///
/// Hips are the deepest joint that carries both legs and the spine, whatever bears their
/// name. Vertebrae from there to the neck become spine; spine and chest; spine, chest and
/// upperChest; of more the lowest, the highest, and between them the one that is nearest
/// to where an average chest is. A joint between the vertebrae and an upper arm is a
/// shoulder; what leads on from a foot is its toes. Twist and helper joints get no bone.
///
/// Errors (bad input), with the joint: no two legs; two joints of one name; bones that do
/// not hang on each other as they must; limbs of no or very unlike lengths.
/// Cost: linear in joints, but for shapes, which look at 48 pairs of branches at most.
[[nodiscard]] Result<FoundBones> identify_bones(const Skeleton& skeleton,
                                                const BoneMap& told = {});

/// What identify_bones() found before it declined a body: nothing is checked, bones may
/// be missing. For a user to correct.
[[nodiscard]] FoundBones guess_bones(const Skeleton& skeleton, const BoneMap& told = {});

/// Sets Joint::bone of every joint, or clears it.
void mark(const FoundBones& found, Skeleton& skeleton);

}  // namespace marey::retarget
