// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/blend/posture_groups.h"

namespace marey::engine {
namespace {

constexpr std::uint8_t place_of(EditGroup group) {
  return static_cast<std::uint8_t>(group);
}

constexpr std::array<std::uint8_t, 4> kLimbGroups{place_of(EditGroup::kLeftArm),
                                                  place_of(EditGroup::kRightArm),
                                                  place_of(EditGroup::kLeftLeg),
                                                  place_of(EditGroup::kRightLeg)};

constexpr EditGroup group_of_segment(HumanBone bone) {
  switch (bone) {
    case HumanBone::kHips:
      return EditGroup::kRoot;
    case HumanBone::kNeck:
    case HumanBone::kHead:
      return EditGroup::kHead;
    case HumanBone::kLeftHand:
      return EditGroup::kLeftArm;
    case HumanBone::kRightHand:
      return EditGroup::kRightArm;
    case HumanBone::kLeftFoot:
    case HumanBone::kLeftToes:
      return EditGroup::kLeftLeg;
    case HumanBone::kRightFoot:
    case HumanBone::kRightToes:
      return EditGroup::kRightLeg;
    default:
      return EditGroup::kTrunk;
  }
}

constexpr std::array<std::uint8_t, kPostureRotations> rotation_groups() {
  std::array<std::uint8_t, kPostureRotations> groups{};
  groups.fill(place_of(EditGroup::kTrunk));
  for (std::size_t i = 0; i < 4; ++i) groups[kLimbRotation + i] = kLimbGroups[i];
  for (std::size_t i = 0; i < kPostureSegments.size(); ++i) {
    groups[kSegmentRotation + i] = place_of(group_of_segment(kPostureSegments[i]));
  }
  for (std::size_t i = 0; i < kNeckKnots; ++i) {
    groups[kNeckRotation + i] = place_of(EditGroup::kHead);
  }
  return groups;
}

constexpr std::array<std::uint8_t, kPostureRotations> kRotationGroups = rotation_groups();

}  // namespace

const std::array<std::uint8_t, kPostureRotations>& group_of_rotation() {
  return kRotationGroups;
}

const std::array<std::uint8_t, 4>& group_of_limb() {
  return kLimbGroups;
}

}  // namespace marey::engine
