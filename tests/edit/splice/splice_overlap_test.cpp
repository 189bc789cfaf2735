// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/splice/splice_overlap.h"

#include <cstddef>

#include <gtest/gtest.h>

#include "tests/edit/ops/splice_scene.h"

namespace marey::edit {
namespace {

TEST(SpliceOverlap, UpperBodyTakesLongerRoundTheSameFrames) {
  const EditState walk = splice_walk();
  const SpliceOverlap plan = plan_splice_overlap(walk, 200, walk, 90, {30, 90, false});
  ASSERT_EQ(plan.last(), 90);
  EXPECT_EQ(plan.body.first, 30);
  EXPECT_EQ(plan.body.last, 60);
  EXPECT_EQ(plan.first_at[static_cast<std::size_t>(plan.join())], 200.0);
  EXPECT_EQ(plan.second_at[static_cast<std::size_t>(plan.join())], 90.0);
  for (std::size_t k = 0; k <= 90; ++k) {
    if (k <= 30) {
      EXPECT_EQ(plan.weight[k], 0.0) << k;
    }
    if (k >= 60) {
      EXPECT_EQ(plan.weight[k], 1.0) << k;
    }
    if (k == 0) continue;
    EXPECT_GT(plan.upper_weight[k], plan.upper_weight[k - 1]) << k;
  }
  EXPECT_EQ(plan.upper_weight.front(), 0.0);
  EXPECT_EQ(plan.upper_weight.back(), 1.0);
}

TEST(SpliceOverlap, BothAreShorterWhereAMotionEnds) {
  const EditState walk = splice_walk();
  const SpliceOverlap plan = plan_splice_overlap(walk, 325, walk, 90, {30, 90, false});
  // 4 frames after the pair, so more before it.
  EXPECT_EQ(plan.first_at.back(), 329.0);
  EXPECT_EQ(plan.body_frames(), 30);
  EXPECT_EQ(plan.last(), 90);
  const SpliceOverlap early = plan_splice_overlap(walk, 325, walk, 6, {30, 90, false});
  EXPECT_EQ(early.body_frames(), 10);
  EXPECT_EQ(early.last(), 10);
}

// The contacts of both motions differ by 8 frames; they are aligned within the overlap of
// the legs, and both motions keep their time beyond it.
TEST(SpliceOverlap, TimeIsWarpedWithinTheOverlapOfTheLegs) {
  const EditState walk = splice_walk();
  int touch_down = 0;
  for (const FrameRange& run : walk.contacts.feet[0].stance) {
    if (run.first > 150 && touch_down == 0) touch_down = run.first;
  }
  ASSERT_GT(touch_down, 0);
  const int enter = touch_down - kSpliceCycle - 8;
  const SpliceOverlap plan =
      plan_splice_overlap(walk, touch_down, walk, enter, {60, 100, true});
  EXPECT_GT(plan.matched_edges, 0);
  EXPECT_GT(plan.max_warp_s, 0.02);
  for (int k = 0; k <= plan.last(); ++k) {
    if (k > plan.body.first && k < plan.body.last) continue;
    const int off = k - plan.join();
    EXPECT_EQ(plan.first_at[static_cast<std::size_t>(k)], touch_down + off) << k;
    EXPECT_EQ(plan.second_at[static_cast<std::size_t>(k)], enter + off) << k;
  }
}

}  // namespace
}  // namespace marey::edit
