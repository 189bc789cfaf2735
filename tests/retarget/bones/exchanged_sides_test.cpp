// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/exchanged_sides.h"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "core/pose.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

FoundBones found_in(const Skeleton& skeleton) {
  FoundBones found;
  for (const B bone : human_bones()) {
    if (const auto joint = skeleton.find(bone))
      found.bones[index(bone)] = FoundBone{*joint};
  }
  return found;
}

void exchange(FoundBones& found, std::initializer_list<B> bones) {
  for (const B bone : bones) {
    std::swap(found.bones[index(bone)], found.bones[index(mirrored(bone))]);
  }
}

constexpr std::array kLegs{
    B::kLeftUpperLeg, B::kLeftLowerLeg, B::kLeftFoot, B::kLeftToes};

ExchangedSides judged(const Motion& motion, const FoundBones& found) {
  return exchanged_sides(side_evidence(motion, found));
}

TEST(ExchangedSides, FindsNothingInAWalkForwardsOrBackwards) {
  Motion walk = testing::synthetic_walk(90, 60.0).motion;
  const FoundBones found = found_in(walk.skeleton);
  const SideEvidence evidence = side_evidence(walk, found);
  ASSERT_TRUE(evidence.knees && evidence.toes && evidence.walk);
  EXPECT_GT(*evidence.knees, 0.8);
  EXPECT_GT(*evidence.toes, 0.8);
  EXPECT_GT(*evidence.walk, 0.8);
  EXPECT_EQ(exchanged_sides(evidence), ExchangedSides::kNone);
  std::ranges::reverse(walk.poses);
  EXPECT_LT(*side_evidence(walk, found).walk, -0.8);
  EXPECT_EQ(judged(walk, found), ExchangedSides::kNone);
}

TEST(ExchangedSides, NamesTheBodyTheLegsOrTheArms) {
  const Motion walk = testing::synthetic_walk(90, 60.0).motion;
  const FoundBones found = found_in(walk.skeleton);
  FoundBones body = found;
  for (const B bone : human_bones()) {
    body.bones[index(bone)] = found.bones[index(mirrored(bone))];
  }
  EXPECT_EQ(judged(walk, body), ExchangedSides::kBody);
  FoundBones legs = found;
  exchange(legs, {kLegs[0], kLegs[1], kLegs[2], kLegs[3]});
  EXPECT_EQ(judged(walk, legs), ExchangedSides::kLegs);
  FoundBones arms = found;
  exchange(arms, {B::kLeftShoulder, B::kLeftUpperArm, B::kLeftLowerArm, B::kLeftHand});
  EXPECT_EQ(judged(walk, arms), ExchangedSides::kArms);
  // Also without toes.
  body.bones[index(B::kLeftToes)] = body.bones[index(B::kRightToes)] = std::nullopt;
  EXPECT_EQ(judged(walk, body), ExchangedSides::kBody);
}

// A single wrong joint is not an exchange.
TEST(ExchangedSides, IsNotDecidedByToesAlone) {
  const Motion walk = testing::synthetic_walk(90, 60.0).motion;
  FoundBones heels = found_in(walk.skeleton);
  SideEvidence evidence = side_evidence(walk, heels);
  evidence.toes = -1.0;
  EXPECT_EQ(exchanged_sides(evidence), ExchangedSides::kNone);
  EXPECT_EQ(exchanged_sides({{}, -1.0, {}, {}, {}}), ExchangedSides::kNone);
}

}  // namespace
}  // namespace marey::retarget
