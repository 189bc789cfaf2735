// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/ball_flight.h"

#include <cmath>
#include <limits>
#include <random>

#include "engine/models/throw_course.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/engine/models/made_reach.h"

namespace marey::engine {
namespace {

using testing::random_between;
using testing::random_direction;

TEST(BallFlight, IsTheParabolaWithoutDrag) {
  const BallState ball = ball_at({1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}, 0.7);
  EXPECT_LT(glm::distance(ball.p_in_world,
                          {1.0 + 2.8, 2.0 + 3.5 - 0.5 * 9.81 * 0.49, 3.0 + 4.2}),
            1e-12);
  EXPECT_NEAR(ball.velocity_m_s.y, 5.0 - 9.81 * 0.7, 1e-12);
}

// Without gravity: x = ln(1 + k v t) / k.
TEST(BallFlight, DragIsThatOfTheClosedForm) {
  BallOptions options;
  options.gravity_m_s2 = 0.0;
  options.drag_1_m = 0.011;
  const BallState ball = ball_at({0, 0, 0}, {0, 0, 30.0}, 1.2345, options);
  EXPECT_NEAR(ball.p_in_world.z, std::log(1.0 + 0.011 * 30.0 * 1.2345) / 0.011, 1e-8);
  EXPECT_NEAR(ball.velocity_m_s.z, 30.0 / (1.0 + 0.011 * 30.0 * 1.2345), 1e-8);
}

TEST(BallFlight, ArrivesInThePlaneOfAGoal) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 velocity(random_between(random, -3, 3),
                              random_between(random, 0, 6),
                              random_between(random, 8, 30));
    BallOptions options;
    options.drag_1_m = i % 2 == 0 ? 0.0 : 0.011;
    const BallPlane goal{{0.0, 1.0, 7.0},
                         random_direction(random) * 0.2 + glm::dvec3(0.0, 0.0, 1.0)};
    const auto arrival = ball_arrival({0.1, 1.9, 0.0}, velocity, goal, options);
    ASSERT_TRUE(arrival);
    EXPECT_NEAR(glm::dot(goal.normal, arrival->p_in_world - goal.p_in_world), 0.0, 1e-9);
    const BallState same = ball_at({0.1, 1.9, 0.0}, velocity, arrival->time_s, options);
    EXPECT_LT(glm::distance(same.p_in_world, arrival->p_in_world), 1e-9);
  }
  EXPECT_FALSE(ball_arrival({0, 1, 0}, {0, 0, -5}, {{0, 0, 7}, {0, 0, 1}}));
}

TEST(BallFlight, AimMeetsThePointByBothArcs) {
  std::mt19937 random(2);
  int met = 0;
  for (int i = 0; i < 60; ++i) {
    BallOptions options;
    options.drag_1_m = i % 3 == 0 ? 0.0 : random_between(random, 0.002, 0.03);
    const glm::dvec3 from(0.2, 1.8, -0.3);
    const glm::dvec3 point(random_between(random, -4, 4),
                           random_between(random, 0, 3),
                           random_between(random, 4, 12));
    const double speed_m_s = random_between(random, 9, 25);
    const auto flat = aim_ball(from, point, speed_m_s, options);
    const auto steep = aim_ball(from, point, speed_m_s, options, BallArc::kSteep);
    ASSERT_EQ(flat.has_value(), steep.has_value());
    if (!flat) continue;
    ++met;
    EXPECT_LE(flat->elevation_rad, steep->elevation_rad);
    for (const BallAim& aim : {*flat, *steep}) {
      const BallState ball =
          ball_at(from, speed_m_s * aim.direction_in_world, aim.time_s, options);
      EXPECT_LT(glm::distance(ball.p_in_world, point), 1e-4);
      EXPECT_LT(glm::distance(throw_direction(0.0, aim.azimuth_rad, aim.elevation_rad),
                              aim.direction_in_world),
                1e-12);
    }
  }
  EXPECT_GT(met, 30);
}

TEST(BallFlight, OutOfRangeIsNoAim) {
  BallOptions drag;
  drag.drag_1_m = 0.011;
  // The range of 10 m/s is 10.19 m.
  EXPECT_TRUE(aim_ball({0, 0, 0}, {0, 0, 10.19}, 10.0));
  EXPECT_FALSE(aim_ball({0, 0, 0}, {0, 0, 10.20}, 10.0));
  EXPECT_FALSE(aim_ball({0, 0, 0}, {0, 0, 10.19}, 10.0, drag));
  EXPECT_FALSE(aim_ball({0, 0, 0}, {0, 0, 5}, 0.0));
  EXPECT_FALSE(aim_ball({0, 0, 0}, {0, std::nan(""), 5}, 10.0));
  const auto up = aim_ball({0, 0, 0}, {0, 2, 0}, 10.0);
  ASSERT_TRUE(up);
  EXPECT_NEAR(up->direction_in_world.y, 1.0, 1e-12);
  EXPECT_FALSE(aim_ball({0, 0, 0}, {0, 6, 0}, 10.0));
}

}  // namespace
}  // namespace marey::engine
