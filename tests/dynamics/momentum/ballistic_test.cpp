// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/momentum/ballistic.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/dynamics/momentum/made_flight.h"
#include "tests/support/truth/momentum_judge.h"

namespace marey::dynamics {
namespace {

using testing::Dice;

glm::dvec3 com_of_pose(const MadeFlight& flight, std::size_t k) {
  return testing::judged_com(flight.skeleton, flight.masses, flight.poses[k]);
}

// Second differences of a parabola are its acceleration, in each frame of the flight.
TEST(MakeBallistic, LetsAnyFlightFallFreely) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Dice dice(7000 + seed);
    MadeFlight flight = made_flight(dice, {.frames = 20 + seed % 60});
    for (Pose& pose : flight.poses) pose.root_in_world += dice.noise(0.01);
    const MadeFlight before = flight;
    const double gravity = seed % 2 == 0 ? 9.81 : dice.between(0.5, 30.0);
    BallisticOptions options;
    options.gravity_m_s2 = gravity;
    options.momentum.largest_turn_rad = 3.2;
    const BallisticReport report = make_ballistic(
        flight.skeleton, flight.masses, flight.rate, flight.poses, options);
    ASSERT_TRUE(report.applied);
    EXPECT_TRUE(report.momentum.applied);
    const double hz = flight.rate.hz;
    double moved_max_m = 0.0;
    for (std::size_t k = 0; k < flight.poses.size(); ++k) {
      const glm::dvec3 here = com_of_pose(flight, k);
      moved_max_m = std::max(moved_max_m, glm::distance(here, com_of_pose(before, k)));
      if (k == 0 || k + 1 == flight.poses.size()) continue;
      const glm::dvec3 bend =
          com_of_pose(flight, k - 1) - 2.0 * here + com_of_pose(flight, k + 1);
      EXPECT_LT(glm::distance(bend * hz * hz, glm::dvec3(0, -gravity, 0)), 1e-7);
    }
    EXPECT_NEAR(report.moved_max_m, moved_max_m, 1e-9);
    EXPECT_LE(report.moved_rms_m, report.moved_max_m);
    for (const std::size_t k : {std::size_t{0}, flight.poses.size() - 1}) {
      EXPECT_EQ(flight.poses[k].root_in_world, before.poses[k].root_in_world);
      EXPECT_EQ(flight.poses[k].parent_from_joint, before.poses[k].parent_from_joint);
    }
    EXPECT_LT(
        testing::largest_sd(testing::judged_momentum(flight.skeleton,
                                                     flight.masses,
                                                     hz,
                                                     flight.poses,
                                                     testing::Differences::kThreePoint)),
        0.01);
  }
}

TEST(MakeBallistic, LeavesAFreeFallInPlace) {
  Dice dice(7500);
  MadeFlight flight = made_flight(dice, {.frames = 50, .max_swing_rad = 0.0});
  // The root of a body that does not bend or turn moves as its centre of mass.
  const BallisticReport report =
      make_ballistic(flight.skeleton, flight.masses, flight.rate, flight.poses);
  EXPECT_LT(report.moved_max_m, 1e-12);
  EXPECT_LT(report.momentum.largest_turn_rad, 1e-9);
  EXPECT_NEAR(report.last_velocity_m_s.y - report.first_velocity_m_s.y,
              -9.81 * 49.0 / 120.0,
              1e-9);
}

TEST(MakeBallistic, TakesGivenEnds) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Dice dice(7600 + seed);
    MadeFlight flight = made_flight(dice, {.frames = 40});
    const std::size_t last = flight.poses.size() - 1;
    BallisticOptions options;
    options.ends = {com_of_pose(flight, 0) + 0.002 * dice.direction(),
                    com_of_pose(flight, last) + 0.002 * dice.direction()};
    const BallisticReport report = make_ballistic(
        flight.skeleton, flight.masses, flight.rate, flight.poses, options);
    ASSERT_TRUE(report.applied);
    EXPECT_LT(glm::distance(com_of_pose(flight, 0), options.ends->first_in_world), 1e-9);
    EXPECT_LT(glm::distance(com_of_pose(flight, last), options.ends->last_in_world),
              1e-9);
    const double t = 7.0 / flight.rate.hz;
    const glm::dvec3 wanted = options.ends->first_in_world +
                              t * report.first_velocity_m_s +
                              glm::dvec3(0.0, -0.5 * 9.81 * t * t, 0.0);
    EXPECT_LT(glm::distance(com_of_pose(flight, 7), wanted), 1e-9);
  }
}

TEST(MakeBallistic, LeavesFewerThanThreePosesUnchanged) {
  Dice dice(7501);
  MadeFlight flight = made_flight(dice, {.frames = 30});
  const Pose second = flight.poses[1];
  flight.poses.resize(2);
  EXPECT_FALSE(
      make_ballistic(flight.skeleton, flight.masses, flight.rate, flight.poses).applied);
  EXPECT_EQ(flight.poses[1].root_in_world, second.root_in_world);
}

TEST(FlightFrames, ReachFromTheLastFrameThatBearsToTheNext) {
  const FrameRate rate{100.0};
  const auto inside = flight_frames(0.104, 0.501, rate, 100);
  ASSERT_TRUE(inside);
  EXPECT_EQ(inside->first, 10);
  EXPECT_EQ(inside->last, 51);
  // On frames: these frames, although 0.29 * 100 is below 29.
  const auto exact = flight_frames(0.29, 0.57, rate, 58);
  ASSERT_TRUE(exact);
  EXPECT_EQ(exact->first, 29);
  EXPECT_EQ(exact->last, 57);
  EXPECT_FALSE(flight_frames(0.29, 0.58, rate, 58));
  EXPECT_FALSE(flight_frames(-0.01, 0.3, rate, 58));
  EXPECT_FALSE(flight_frames(0.3, 0.3, rate, 58));
  EXPECT_FALSE(flight_frames(0.3, std::numeric_limits<double>::quiet_NaN(), rate, 58));
}

}  // namespace
}  // namespace marey::dynamics
