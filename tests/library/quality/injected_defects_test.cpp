// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Defects put into a walk with known truth. The gate reports the kind and the frames.
#include "tests/support/simulation/injected_defects.h"

#include <cstdlib>
#include <string>

#include "library/clips/normal_form.h"
#include <gtest/gtest.h>

#include "core/pose.h"
#include "tests/library/quality/quality_scenes.h"

namespace marey::library {
namespace {

using testing::Defect;

struct Case {
  Defect defect;
  const char* kind;
};

class InjectedDefects : public ::testing::TestWithParam<Case> {};

TEST_P(InjectedDefects, AreNamedAndPlaced) {
  const LibraryMotion clean = walking_clip(180, 60.0);
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
    const auto injected = testing::inject(clean.motion, GetParam().defect, seed);
    ASSERT_TRUE(injected.has_value());
    const auto clip = make_library_motion(injected->motion);
    ASSERT_TRUE(clip.has_value());
    const QualityResult result = measured(*clip);
    EXPECT_NE(result.quality, Verdict::kPass) << "seed " << seed;
    EXPECT_EQ(result.main_kind, GetParam().kind) << "seed " << seed;
    if (!injected->is_local) continue;
    bool placed = false;
    for (const ClipProblem& problem : result.problems) {
      placed = placed || (problem.kind == GetParam().kind &&
                          std::abs(problem.frames.first - injected->frames.first) <= 3 &&
                          std::abs(problem.frames.last - injected->frames.last) <= 3);
    }
    EXPECT_TRUE(placed) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Library,
                         InjectedDefects,
                         ::testing::Values(Case{Defect::kSpike5cm, "spike"},
                                           Case{Defect::kSpike10cm, "spike"},
                                           Case{Defect::kLegsCrossed, "swap"},
                                           Case{Defect::kSlide10cmS, "slide"},
                                           Case{Defect::kJitter1mm, "jitter"},
                                           Case{Defect::kJitter3mm, "jitter"},
                                           Case{Defect::kFrozenArm, "frozen"},
                                           Case{Defect::kScale100, "scale"},
                                           Case{Defect::kFloor3cm, "float"},
                                           Case{Defect::kForearmFlip, "flip"},
                                           Case{Defect::kCut300ms, "cut"},
                                           Case{Defect::kMirrored, "sides"}));

// The tool itself: one frame differs, and by the stated distance.
TEST(InjectedDefect, ASpikeMovesTheEndOfOneLimb) {
  const LibraryMotion clean = walking_clip(120, 60.0);
  const auto injected = testing::inject(clean.motion, Defect::kSpike10cm, 7);
  ASSERT_TRUE(injected.has_value());
  const auto joint = index(*clean.motion.skeleton.find(*injected->bone));
  for (std::size_t t = 0; t < 120; ++t) {
    const double moved_m = glm::length(
        world_from_joints(clean.motion.skeleton, clean.motion.poses[t])[joint]
            .translation -
        world_from_joints(clean.motion.skeleton, injected->motion.poses[t])[joint]
            .translation);
    const bool is_spike = static_cast<int>(t) == injected->frames.first;
    EXPECT_NEAR(moved_m, is_spike ? 0.1 : 0.0, 1e-9) << t;
  }
}

TEST(InjectedDefect, TheSameSeedMakesTheSameDefect) {
  const LibraryMotion clean = walking_clip(120, 60.0);
  const auto a = testing::inject(clean.motion, Defect::kJitter3mm, 5);
  const auto b = testing::inject(clean.motion, Defect::kJitter3mm, 5);
  ASSERT_TRUE(a.has_value());
  ASSERT_TRUE(b.has_value());
  EXPECT_EQ(a->motion.poses[50].root_in_world, b->motion.poses[50].root_in_world);
}

}  // namespace
}  // namespace marey::library
