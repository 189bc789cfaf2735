// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/character/joint_limits.h"

#include <optional>

#include "core/human/joint_ranges.h"
#include "core/humanoid.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

const BoneLimit* find(const std::vector<BoneLimit>& limits, B bone) {
  for (const BoneLimit& limit : limits) {
    if (limit.bone == bone) return &limit;
  }
  return nullptr;
}

std::optional<BoneLimit> limit_of(const BodyMap& map,
                                  const CharacterTraits& traits,
                                  std::size_t joint,
                                  int vertebrae) {
  for (const HumanBone bone : human_bones()) {
    if (map.joint_of[index(bone)] != JointIndex{static_cast<int>(joint)}) continue;
    if (const BoneLimit* own = find(traits.limits, bone)) return *own;
    if (map.joints[joint].role == JointRole::kVertebra || !traits.has_limits) break;
    return joint_range(bone);
  }
  if (!traits.has_limits || map.joints[joint].role != JointRole::kVertebra) {
    return std::nullopt;
  }
  return spine_range(vertebrae);
}

}  // namespace

std::vector<JointLimit> joint_limits(const BodyMap& map, const CharacterTraits& traits) {
  std::vector<JointLimit> limits;
  const int vertebrae = map.abdomen.count + map.torso.count;
  for (std::size_t i = 0; i < map.joints.size(); ++i) {
    const auto limit = limit_of(map, traits, i, vertebrae);
    if (!limit) continue;
    limits.push_back({JointIndex{static_cast<int>(i)},
                      map.joints[i].t_pose_from_joint,
                      limit->min_rad,
                      limit->max_rad});
  }
  return limits;
}

}  // namespace marey::retarget
