// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/sources/stride_phase.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/engine/made_performer.h"

namespace marey::engine {
namespace {

const MotionClip& made_clip(std::string_view name) {
  static const auto kBase = made_base();
  return kBase->clip(*kBase->find(name));
}

TEST(StridePhase, GoesFromLandingToLanding) {
  const MotionClip& walk = made_clip("walk");
  EXPECT_EQ(count_strides(walk), 1);
  double before = *stride_phase(walk, 0.0);
  double total = 0.0;
  for (int i = 1; i <= 220; ++i) {
    const double now = *stride_phase(walk, 0.01 * i);
    const double change = std::remainder(now - before, 1.0);
    // The stride takes 1.1 s; both of its steps take half of that.
    EXPECT_NEAR(change, 0.01 / 1.1, 0.002) << i;
    total += change;
    before = now;
  }
  EXPECT_NEAR(total, 2.0, 1e-6);
}

TEST(StridePhase, FindsTheTimeOfAPhase) {
  for (const char* name : {"walk", "stroll"}) {
    for (int i = 0; i < 40; ++i) {
      const double phase = i / 40.0;
      const auto time_s = time_of_stride(made_clip(name), phase);
      ASSERT_TRUE(time_s);
      EXPECT_NEAR(
          std::remainder(*stride_phase(made_clip(name), *time_s + 1e-7) - phase, 1.0),
          0.0,
          1e-5);
    }
  }
}

TEST(StridePhase, IsUnknownWithoutALoop) {
  EXPECT_FALSE(stride_phase(made_clip("steps"), 0.5));
  EXPECT_FALSE(time_of_stride(made_clip("still"), 0.5));
  EXPECT_EQ(count_strides(made_clip("still")), 0);
}

TEST(LeadPhase, FollowsAPerformersSteps) {
  for (const double tempo : {0.7, 1.0, 1.4}) {
    const MadePerformer performer{.tempo = tempo};
    LeadPhase lead;
    for (int i = 0; i < 400; ++i) {
      const double time_s = i / 60.0;
      lead.observe(time_s, performer.at(time_s).bears);
      const auto phase = lead.phase(time_s);
      if (time_s < 2.0 / tempo) continue;
      ASSERT_TRUE(phase);
      const double truth =
          *stride_phase(made_clip("walk"), performer.start_s + tempo * time_s);
      // A landing is seen up to a step late; the walk's two steps differ by the same.
      EXPECT_LT(std::abs(std::remainder(*phase - truth, 1.0)), 0.04) << time_s;
    }
  }
}

TEST(LeadPhase, ForgetsAPerformerWhoStands) {
  const MadePerformer performer;
  LeadPhase lead;
  for (int i = 0; i < 200; ++i) lead.observe(i / 60.0, performer.at(i / 60.0).bears);
  EXPECT_TRUE(lead.phase(200 / 60.0));
  EXPECT_FALSE(lead.phase(200 / 60.0 + 1.0));
}

TEST(LeadPhase, ReturnsWithALandingAfterAnInterruption) {
  const MadePerformer performer;
  LeadPhase lead;
  for (int i = 0; i < 200; ++i) lead.observe(i / 60.0, performer.at(i / 60.0).bears);
  lead.interrupt();
  EXPECT_FALSE(lead.phase(200 / 60.0));
  for (int i = 263; i < 300; ++i) lead.observe(i / 60.0, performer.at(i / 60.0).bears);
  const double truth = *stride_phase(made_clip("walk"), performer.start_s + 300 / 60.0);
  ASSERT_TRUE(lead.phase(300 / 60.0));
  EXPECT_NEAR(std::remainder(*lead.phase(300 / 60.0) - truth, 1.0), 0.0, 0.04);
}

TEST(LeadPhase, IsUnknownForHopsOnOneFoot) {
  LeadPhase lead;
  for (int i = 0; i < 200; ++i) {
    lead.observe(i / 60.0, i % 40 < 20 ? 1U : 0U);
    EXPECT_FALSE(lead.phase(i / 60.0));
  }
}

}  // namespace
}  // namespace marey::engine
