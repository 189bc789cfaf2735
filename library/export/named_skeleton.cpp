// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/export/named_skeleton.h"

#include <array>
#include <cstddef>
#include <utility>

#include "core/human/average_proportions.h"
#include "core/library/joint_names.h"

namespace marey::library {
namespace {

constexpr std::array<std::string_view, 3> kSkeletonNames{"marey", "smpl22", "lafan22"};

/// Returns `skeleton`, which has the order of human_bones(), with other names and another
/// order.
Skeleton reordered(const Skeleton& skeleton, const NamedBones& order) {
  std::array<int, kHumanBoneCount> place{};
  for (std::size_t j = 0; j < order.size(); ++j) {
    place[index(order[j].bone)] = static_cast<int>(j);
  }
  Skeleton out;
  for (const auto& [bone, joint_name] : order) {
    Joint joint = skeleton.joints[index(bone)];
    joint.name = joint_name;
    if (joint.parent) joint.parent = JointIndex{place[index(*joint.parent)]};
    out.joints.push_back(std::move(joint));
  }
  return out;
}

}  // namespace

std::string_view name(NamedSkeleton skeleton) {
  return kSkeletonNames[static_cast<std::size_t>(skeleton)];
}

std::optional<NamedSkeleton> named_skeleton(std::string_view name) {
  if (name == "humanoid") return NamedSkeleton::kMarey;
  for (std::size_t i = 0; i < kSkeletonNames.size(); ++i) {
    if (kSkeletonNames[i] == name) return static_cast<NamedSkeleton>(i);
  }
  return std::nullopt;
}

Skeleton make_named_skeleton(NamedSkeleton skeleton, double stature_m) {
  Skeleton humanoid = make_humanoid(average_proportions(stature_m));
  switch (skeleton) {
    case NamedSkeleton::kMarey:
      break;
    case NamedSkeleton::kSmpl22:
      return reordered(humanoid, kSmplJoints);
    case NamedSkeleton::kLafan22:
      return reordered(humanoid, kLafanJoints);
  }
  return humanoid;
}

}  // namespace marey::library
