// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/sync/phases.h"

#include "engine/sync/phase_ring.h"
#include <gtest/gtest.h>

namespace marey::engine {
namespace {

MotionClip walking_clip() {
  MotionClip clip;
  clip.rate_hz = 10.0F;
  clip.frames.resize(11);
  clip.contacts[0] = {{0.0F, 0.25F}};                  // Left heel.
  clip.contacts[1] = {{0.125F, 0.5F}};                 // Left ball.
  clip.contacts[2] = {{0.4375F, 0.75F}};               // Right heel.
  clip.contacts[3] = {{0.5F, 0.75F}, {0.875F, 1.0F}};  // Right ball.
  return clip;
}

TEST(Phases, JoinHeelAndBallAndCoverTheClip) {
  const auto phases = phases_of(walking_clip());
  ASSERT_EQ(phases.size(), 5U);
  EXPECT_EQ(phases[0].feet, PhaseClass::kLeft);
  EXPECT_EQ(phases[1].feet, PhaseClass::kBoth);
  EXPECT_EQ(phases[2].feet, PhaseClass::kRight);
  EXPECT_EQ(phases[3].feet, PhaseClass::kNone);
  EXPECT_EQ(phases[4].feet, PhaseClass::kRight);
  EXPECT_EQ(phases.front().start_s, 0.0);
  EXPECT_DOUBLE_EQ(phases.back().end_s, 1.0);
  for (std::size_t i = 1; i < phases.size(); ++i) {
    EXPECT_EQ(phases[i].start_s, phases[i - 1].end_s);
  }
}

TEST(Phases, ShortOnesJoinTheLongerNeighbour) {
  const auto phases = phases_of(walking_clip(), 0.1);
  ASSERT_EQ(phases.size(), 4U);
  EXPECT_EQ(phases[0].feet, PhaseClass::kLeft);
  EXPECT_DOUBLE_EQ(phases[0].end_s, 0.5);
}

TEST(Phases, AreUnknownWithoutContacts) {
  MotionClip clip = walking_clip();
  clip.contacts = {};
  const auto phases = phases_of(clip);
  ASSERT_EQ(phases.size(), 1U);
  EXPECT_EQ(phases[0].feet, PhaseClass::kAny);
  EXPECT_DOUBLE_EQ(phases[0].end_s, 1.0);
}

TEST(Phases, AreCompatibleAsInTheTable) {
  using enum PhaseClass;
  for (const PhaseClass feet : {kNone, kLeft, kRight, kBoth, kAny}) {
    EXPECT_TRUE(are_compatible(feet, feet, 9.0));
    EXPECT_TRUE(are_compatible(feet, kAny, 9.0));
    EXPECT_TRUE(are_compatible(kAny, feet, 9.0));
  }
  for (const PhaseClass foot : {kLeft, kRight}) {
    EXPECT_TRUE(are_compatible(foot, kBoth, 9.0));
    EXPECT_TRUE(are_compatible(kBoth, foot, 9.0));
  }
  for (const PhaseClass feet : {kLeft, kRight, kBoth}) {
    EXPECT_TRUE(are_compatible(kNone, feet, 0.1));
    EXPECT_FALSE(are_compatible(kNone, feet, 0.11));
    EXPECT_FALSE(are_compatible(feet, kNone, 0.11));
  }
  EXPECT_FALSE(are_compatible(kLeft, kRight, 0.0));
  EXPECT_FALSE(are_compatible(kRight, kLeft, 0.0));
}

TEST(PhaseRing, JoinsThePhasesAtTheSeam) {
  const std::vector<Phase> phases{{PhaseClass::kLeft, 0.0, 0.1},
                                  {PhaseClass::kRight, 0.1, 0.5},
                                  {PhaseClass::kLeft, 0.5, 0.8}};
  const PhaseRing ring(phases, 0.8, true);
  EXPECT_EQ(ring.edges(), 2U);
  const auto place = ring.at(0.05);
  EXPECT_NEAR(ring.start_s(place), -0.3, 1e-12);
  EXPECT_NEAR(ring.end_s(place), 0.1, 1e-12);
}

}  // namespace
}  // namespace marey::engine
