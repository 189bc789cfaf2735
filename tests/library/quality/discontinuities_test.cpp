// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/discontinuities.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/library/quality/quality_scenes.h"
#include "tests/support/simulation/injected_defects.h"

namespace marey::library {
namespace {

std::size_t joint(const LibraryMotion& clip, HumanBone bone) {
  return index(*clip.motion.skeleton.find(bone));
}

// An arm that waves on a body at rest; 0.3 s of it are missing.
TEST(Discontinuities, ACutOfOneArmIsFound) {
  LibraryMotion clip = standing_clip(120, 30.0);
  for (int t = 0; t < 120; ++t) {
    const int u = t < 60 ? t : t + 9;
    clip.motion.poses[static_cast<std::size_t>(t)]
        .parent_from_joint[joint(clip, HumanBone::kLeftShoulder)] =
        glm::angleAxis(0.3 * std::sin(0.1 * u), glm::dvec3(0.0, 0.0, 1.0));
  }
  const QualityResult result = measured(clip);
  EXPECT_EQ(result.main_kind, "cut");
  EXPECT_EQ(figure(result, "cut").frames->first, 59);
  EXPECT_EQ(figure(result, "cut").frames->last, 60);
}

// A step of the whole body is shared by all bones: it is a cut, but no noise.
TEST(Discontinuities, SharedShaking) {
  LibraryMotion clip = standing_clip(120, 30.0);
  for (std::size_t t = 0; t < 120; ++t) {
    clip.motion.poses[t].root_in_world.y += t % 2 == 0 ? 0.0003 : -0.0003;
  }
  const double shaken_mm = figure(measured(clip), "jitter_mm").value;
  EXPECT_GT(shaken_mm, 0.0);
  EXPECT_LT(shaken_mm, 0.25);
}

// Noise of all joints has about the stated figure, at rest and in a walk.
TEST(Discontinuities, JitterIsTheNoiseOfTheJoints) {
  for (const double hz : {30.0, 60.0, 120.0}) {
    const LibraryMotion clean = walking_clip(static_cast<int>(4.0 * hz), hz);
    const auto noisy = testing::inject(clean.motion, testing::Defect::kJitter1mm, 11);
    ASSERT_TRUE(noisy.has_value());
    LibraryMotion clip = clean;
    clip.motion = noisy->motion;
    EXPECT_LT(figure(measured(clean), "jitter_mm").value, 0.3) << hz;
    EXPECT_NEAR(figure(measured(clip), "jitter_mm").value, 1.1, 0.25) << hz;
  }
}

// Noise of 3 mm is not reported as displaced joints, at any rate.
TEST(Discontinuities, NoiseIsNoSpike) {
  for (const double hz : {30.0, 60.0, 120.0}) {
    LibraryMotion clip = walking_clip(static_cast<int>(4.0 * hz), hz);
    const auto noisy = testing::inject(clip.motion, testing::Defect::kJitter3mm, 12);
    ASSERT_TRUE(noisy.has_value());
    clip.motion = noisy->motion;
    EXPECT_EQ(measured(clip).main_kind, "jitter") << hz;
  }
}

}  // namespace
}  // namespace marey::library
