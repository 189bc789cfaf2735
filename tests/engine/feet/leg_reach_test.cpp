// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/feet/leg_reach.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace marey::engine {
namespace {

constexpr double kReachingLeg_m = 0.85;

TEST(LegReach, LeavesBentLegsAndNeverStretchesThemCompletely) {
  EXPECT_DOUBLE_EQ(leg_reach_m(0.7, kReachingLeg_m), 0.7);
  double last_m = 0.0;
  for (double d_m = 0.8; d_m < 1.2; d_m += 0.001) {
    const double reach_m = leg_reach_m(d_m, kReachingLeg_m);
    EXPECT_GE(reach_m, last_m);
    EXPECT_LE(reach_m - last_m, last_m > 0.0 ? 0.001 + 1e-12 : 1.0);
    EXPECT_LE(reach_m, kMostReach * kReachingLeg_m + 1e-12);
    last_m = reach_m;
  }
}

TEST(LegReach, LowersTheHipsJustEnough) {
  const glm::dvec3 ankle(0.3, 0.08, -0.2);
  const glm::dvec3 hip(0.1, 0.9, 0.1);
  const double leg_m = 0.88;
  const double drop_m = hips_drop_m(hip, ankle, leg_m);
  EXPECT_GT(drop_m, 0.0);
  const glm::dvec3 lower = hip - glm::dvec3(0.0, drop_m, 0.0);
  EXPECT_NEAR(
      glm::distance(lower, ankle), leg_reach_m(glm::distance(hip, ankle), leg_m), 1e-12);
  EXPECT_EQ(hips_drop_m(hip, ankle, 1.2), 0.0);
  // No height suffices.
  EXPECT_EQ(hips_drop_m(hip, {2.0, 0.0, 0.0}, leg_m), 0.0);
}

TEST(LegReach, BringsAnAnkleWithinReachAlongTheLeg) {
  const glm::dvec3 hip(0.0, 1.0, 0.0);
  const glm::dvec3 ankle(0.6, 0.2, 0.0);
  EXPECT_EQ(ankle_within(hip, ankle, 1.1), ankle);
  const glm::dvec3 nearer = ankle_within(hip, ankle, 0.8);
  EXPECT_NEAR(glm::distance(nearer, hip), 0.8, 1e-12);
  EXPECT_NEAR(glm::length(glm::cross(nearer - hip, ankle - hip)), 0.0, 1e-12);
}

}  // namespace
}  // namespace marey::engine
