// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/contradicted_sizes.h"

#include <gtest/gtest.h>

namespace marey::library {
namespace {

std::vector<ClipBody> bodies(int count, const std::string& subject) {
  return std::vector<ClipBody>(static_cast<std::size_t>(count),
                               ClipBody{subject, 1.7, 2.345});
}

TEST(ContradictedSizes, OneOfTenIsFoundBySubject) {
  std::vector<ClipBody> clips = bodies(10, "ann");
  clips[6].stature_m = 1.87;
  clips[6].proportions = 0.0;  // Unknown: the subject is enough.
  const auto found = find_contradicted_sizes(clips);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].clip, 6U);
  EXPECT_NEAR(found[0].ratio, 1.1, 1e-9);
  EXPECT_NEAR(found[0].usual_m, 1.7, 1e-12);
  EXPECT_EQ(found[0].others, 9U);
  const ClipProblem problem = problem_of(found[0], 100);
  EXPECT_EQ(problem.kind, "scale");
  EXPECT_EQ(problem.frames.last, 99);
}

TEST(ContradictedSizes, OneOfTenIsFoundByProportions) {
  std::vector<ClipBody> clips = bodies(10, "");
  clips[3].stature_m = 1.53;
  ASSERT_EQ(find_contradicted_sizes(clips).size(), 1U);
  EXPECT_EQ(find_contradicted_sizes(clips)[0].clip, 3U);
}

// Persons of different sizes are no contradiction.
TEST(ContradictedSizes, OtherPersonsAreNot) {
  std::vector<ClipBody> clips = bodies(5, "ann");
  for (ClipBody clip : bodies(5, "ben")) {
    clip.stature_m = 1.9;
    clips.push_back(clip);
  }
  EXPECT_TRUE(find_contradicted_sizes(clips).empty());
  std::vector<ClipBody> unknown = bodies(9, "");
  unknown[4].stature_m = 1.9;
  unknown[4].proportions = 2.4;
  EXPECT_TRUE(find_contradicted_sizes(unknown).empty());
}

// Two clips do not say which one is wrong, and neither do two halves.
TEST(ContradictedSizes, AMajorityIsNeeded) {
  std::vector<ClipBody> clips = bodies(2, "ann");
  clips[1].stature_m = 1.87;
  EXPECT_TRUE(find_contradicted_sizes(clips).empty());
  clips = bodies(6, "ann");
  for (std::size_t k = 3; k < 6; ++k) clips[k].stature_m = 1.87;
  EXPECT_TRUE(find_contradicted_sizes(clips).empty());
}

// Refitted skeletons of one person differ by some percent.
TEST(ContradictedSizes, SmallDifferencesAreTolerated) {
  std::vector<ClipBody> clips = bodies(10, "ann");
  clips[2].stature_m = 1.75;
  EXPECT_TRUE(find_contradicted_sizes(clips).empty());
}

}  // namespace
}  // namespace marey::library
