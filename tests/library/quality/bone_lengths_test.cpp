// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/bone_lengths.h"

#include <gtest/gtest.h>

namespace marey::library {
namespace {

TEST(BoneLengths, TheRangeIsThatOfTheWorstBone) {
  std::vector<std::vector<glm::dvec3>> read{
      std::vector<glm::dvec3>(10, glm::dvec3(0.0, 0.3, 0.0)),
      std::vector<glm::dvec3>(10, glm::dvec3(0.0, 0.0, 0.25)),
      {}};
  read[0][2] = {0.301, 0.0, 0.0};  // Turned, and longer by 1 mm.
  read[1][6] = {0.0, 0.0, 0.27};
  read[1][7] = {0.0, 0.0, 0.24};
  const std::optional<HumanBone> bones[]{
      HumanBone::kLeftHand, HumanBone::kRightFoot, std::nullopt};
  const FoundFigure found = bone_length_range_mm(read, bones, 3.0);
  EXPECT_EQ(found.name, "bones_mm");
  EXPECT_NEAR(found.value, 30.0, 1e-9);
  EXPECT_EQ(found.bone, HumanBone::kRightFoot);
  EXPECT_EQ(found.frames->first, 6);
  ASSERT_EQ(found.places.size(), 1U);
  EXPECT_EQ(found.places[0].frames.first, 6);
  EXPECT_EQ(found.places[0].frames.last, 7);
}

TEST(BoneLengths, ARigidBodyHasNoRange) {
  const std::vector<std::vector<glm::dvec3>> read{
      {{0.0, 0.3, 0.0}, {0.3, 0.0, 0.0}, {0.0, 0.0, 0.3}}};
  const FoundFigure found = bone_length_range_mm(read, {}, 3.0);
  EXPECT_NEAR(found.value, 0.0, 1e-12);
  EXPECT_TRUE(found.places.empty());
  EXPECT_EQ(bone_length_range_mm({}, {}, 3.0).value, 0.0);
}

}  // namespace
}  // namespace marey::library
