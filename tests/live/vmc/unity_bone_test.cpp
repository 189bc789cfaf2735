// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/unity_bone.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace marey::live {
namespace {

TEST(UnityBone, HasUnitysNumbers) {
  // UnityEngine.HumanBodyBones, whose numbers are part of Unity's API.
  EXPECT_EQ(index(UnityBone::kHips), 0U);
  EXPECT_EQ(index(UnityBone::kHead), 10U);
  EXPECT_EQ(index(UnityBone::kRightToes), 20U);
  EXPECT_EQ(index(UnityBone::kLeftThumbProximal), 24U);
  EXPECT_EQ(index(UnityBone::kRightThumbProximal), 39U);
  EXPECT_EQ(index(UnityBone::kUpperChest), 54U);
}

TEST(UnityBone, NamesAllFiftyFiveOnce) {
  std::set<std::string> names;
  for (int i = 0; i < kUnityBoneCount; ++i) {
    const auto bone = static_cast<UnityBone>(i);
    names.insert(std::string(name(bone)));
    EXPECT_EQ(unity_bone(name(bone)), bone);
  }
  EXPECT_EQ(names.size(), 55U);
}

TEST(UnityBone, DoesNotCareForCase) {
  EXPECT_EQ(unity_bone("leftUpperArm"), UnityBone::kLeftUpperArm);
  EXPECT_EQ(unity_bone("UPPERCHEST"), UnityBone::kUpperChest);
  EXPECT_EQ(unity_bone("Left Upper Arm"), std::nullopt);
  EXPECT_EQ(unity_bone(""), std::nullopt);
}

TEST(UnityBone, KnowsEveryBoneOfOurs) {
  int known = 0;
  for (const HumanBone bone : human_bones()) {
    EXPECT_EQ(human_bone(unity_bone(bone)), bone);
  }
  for (int i = 0; i < kUnityBoneCount; ++i) {
    known += human_bone(static_cast<UnityBone>(i)).has_value();
  }
  EXPECT_EQ(known, kHumanBoneCount);
  EXPECT_EQ(human_bone(UnityBone::kLeftThumbProximal), std::nullopt);
  EXPECT_EQ(unity_bone(HumanBone::kLeftToes), UnityBone::kLeftToes);
}

TEST(UnityBone, RequiresFifteen) {
  int required = 0;
  for (const HumanBone bone : human_bones()) required += is_required(bone);
  EXPECT_EQ(required, 15);
}

}  // namespace
}  // namespace marey::live
