// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/feet/floor_ride.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "retarget/feet/floor_at.h"

namespace marey::engine {
namespace {

constexpr double kAnkle_m = 0.08;
constexpr double kFrame_s = 1.0 / 60.0;

std::array<FloorRide::Foot, 2> standing_feet() {
  return {FloorRide::Foot{true, {0.1, kAnkle_m, 0.0}, kAnkle_m},
          FloorRide::Foot{true, {-0.1, kAnkle_m, 0.2}, kAnkle_m}};
}

Floor sliding_ramp() {
  Floor floor;
  floor.parts.push_back({.name = "ramp",
                         .min_xz_m = {-2.0, -2.0},
                         .max_xz_m = {2.0, 2.0},
                         .height_m = 0.3,
                         .slope = {0.05, -0.1},
                         .path = {{0.0, glm::dvec3(0.0)}, {1.0, {0.5, 0.2, -0.4}}}});
  return floor;
}

TEST(FloorRide, LeavesFeetOnALevelFloorToTheBit) {
  FloorRide ride;
  for (int step = 1; step <= 30; ++step) {
    const auto shifts = ride.step({}, step * kFrame_s, kFrame_s, standing_feet());
    for (const FloorShift& shift : shifts) {
      EXPECT_EQ(shift.moved_m, glm::dvec3(0.0));
      EXPECT_EQ(shift.turn, glm::dquat(1.0, 0.0, 0.0, 0.0));
      EXPECT_EQ(shift.carried_m, glm::dvec3(0.0));
    }
  }
}

TEST(FloorRide, PutsSolesOnTheRampAndCarriesThemWithIt) {
  const Floor floor = sliding_ramp();
  FloorRide ride;
  const auto feet = standing_feet();
  const glm::dvec3 began_m = retarget::moved_at(floor.parts[0], kFrame_s);
  for (int step = 1; step <= 90; ++step) {
    const double time_s = step * kFrame_s;
    const auto shifts = ride.step(floor, time_s, kFrame_s, feet);
    const glm::dvec3 carried_m = retarget::moved_at(floor.parts[0], time_s) - began_m;
    for (std::size_t side = 0; side < 2; ++side) {
      const glm::dvec3 ankle = feet[side].ankle_in_level + shifts[side].moved_m;
      const glm::dvec3 up = shifts[side].turn * glm::dvec3(0.0, 1.0, 0.0);
      const glm::dvec3 sole = ankle - kAnkle_m * up;
      const auto spot = retarget::floor_at(floor, {sole.x, sole.z}, time_s);
      EXPECT_NEAR(sole.y, spot.height_m, 1e-12);
      EXPECT_NEAR(glm::dot(up, spot.normal_in_world), 1.0, 1e-12);
      EXPECT_LT(glm::distance(shifts[side].carried_m, carried_m), 1e-12);
    }
  }
}

TEST(FloorRide, LetsAFreeFootFollowTheOtherOne) {
  const Floor floor = sliding_ramp();
  FloorRide ride;
  auto feet = standing_feet();
  static_cast<void>(ride.step(floor, kFrame_s, kFrame_s, feet));
  feet[1].stands = false;
  std::array<FloorShift, 2> last{};
  for (int step = 2; step <= 200; ++step) {
    const auto shifts = ride.step(floor, step * kFrame_s, kFrame_s, feet);
    if (step > 2) {
      EXPECT_LT(glm::distance(shifts[1].moved_m, last[1].moved_m), 0.02);
    }
    last = shifts;
  }
  EXPECT_LT(glm::distance(last[0].carried_m, last[1].carried_m), 1e-6);
}

TEST(FloorRide, LandsOnAnotherHeightWithoutAJump) {
  Floor floor;
  floor.parts.push_back({.name = "step",
                         .min_xz_m = {-1.0, 0.5},
                         .max_xz_m = {1.0, 1.5},
                         .height_m = 0.15,
                         .slope = {0.0, 0.0},
                         .path = {}});
  FloorRide ride;
  auto feet = standing_feet();
  static_cast<void>(ride.step(floor, kFrame_s, kFrame_s, feet));
  double last_m = 0.0;
  for (int step = 2; step <= 80; ++step) {
    feet[0].stands = step > 20;
    feet[0].ankle_in_level.z = std::min(1.0, 0.05 * step);
    const auto shifts = ride.step(floor, step * kFrame_s, kFrame_s, feet);
    EXPECT_LT(std::abs(shifts[0].moved_m.y - last_m), 0.03) << "step " << step;
    last_m = shifts[0].moved_m.y;
  }
  EXPECT_NEAR(last_m, 0.15, 1e-3);
}

}  // namespace
}  // namespace marey::engine
