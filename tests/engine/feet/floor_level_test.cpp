// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/feet/floor_level.h"

#include <cmath>

#include <gtest/gtest.h>

namespace marey::engine {
namespace {

constexpr double kFloorStep_s = 1.0 / 120.0;
constexpr double kFarFromFloor_m = 0.08;

TEST(FloorLevel, MeetsAFootThatBearsFromTheStart) {
  FloorLevel floor;
  EXPECT_DOUBLE_EQ(floor.step(0.03, kFarFromFloor_m, kFloorStep_s), -0.03);
  EXPECT_DOUBLE_EQ(floor.step(0.03, kFarFromFloor_m, kFloorStep_s), -0.03);
}

TEST(FloorLevel, FollowsAFloorThatJumpsWithoutAJump) {
  FloorLevel floor;
  (void)floor.step(0.0, kFarFromFloor_m, kFloorStep_s);
  double last_m = 0.0;
  double fastest_m_s = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double lift_m = floor.step(0.04, kFarFromFloor_m, kFloorStep_s);
    EXPECT_LE(lift_m, last_m);  // It does not overshoot.
    fastest_m_s = std::max(fastest_m_s, (last_m - lift_m) / kFloorStep_s);
    last_m = lift_m;
  }
  EXPECT_NEAR(last_m, -0.04, 1e-4);
  // The peak of a critically damped spring is size / (e time constant).
  EXPECT_LT(fastest_m_s, 0.04 / (std::exp(1.0) * FloorLevel::kTime_s) * 1.01);
}

TEST(FloorLevel, KeepsItsValueInFlightsAndForFeetInTheAir) {
  FloorLevel floor;
  for (int i = 0; i < 60; ++i) (void)floor.step(0.02, kFarFromFloor_m, kFloorStep_s);
  EXPECT_DOUBLE_EQ(floor.step(std::nullopt, kFarFromFloor_m, kFloorStep_s), -0.02);
  EXPECT_DOUBLE_EQ(floor.step(0.2, kFarFromFloor_m, kFloorStep_s), -0.02);
}

}  // namespace
}  // namespace marey::engine
