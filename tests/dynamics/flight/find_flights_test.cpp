// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/flight/find_flights.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::dynamics {
namespace {

using testing::Dice;

constexpr double kGravity = 9.81;

/// A person who stands, crouches, jumps and lands. The floor's force decreases to zero,
/// and increases again, over 30 ms.
struct Jump {
  double takeoff_s = 1.0;
  double landing_s = 0.0;

  [[nodiscard]] double acceleration(double t) const {
    const double push = 14.0;
    if (t < takeoff_s) {
      const double before = takeoff_s - t;
      if (before < 0.03) return -kGravity + (push + kGravity) * before / 0.03;
      if (before < 0.23) return push;
      return before < 0.53 ? -3.0 : 0.0;
    }
    if (t < landing_s) return -kGravity;
    const double after = t - landing_s;
    if (after < 0.03) return -kGravity + (20.0 + kGravity) * after / 0.03;
    return after < 0.1 ? 20.0 : 0.0;
  }
};

/// Returns poses of `seconds` at a rate; the body does not bend, so that its root moves
/// as its centre of mass.
Motion jumping(const Jump& jump, double rate_hz, double seconds, double noise_m) {
  Motion motion;
  motion.skeleton = make_humanoid(average_proportions(1.75));
  motion.rate = FrameRate{rate_hz};
  const Pose rest = rest_pose(motion.skeleton);
  Dice dice(7);
  constexpr double kStepS = 1e-5;
  double speed = 0.0;
  double height = 0.0;
  double next_s = 0.0;
  for (double t = 0.0; t < seconds; t += kStepS) {
    if (t >= next_s) {
      motion.poses.push_back(rest);
      motion.poses.back().root_in_world.y += height + dice.noise(noise_m);
      next_s = static_cast<double>(motion.poses.size()) / rate_hz;
    }
    speed += kStepS * jump.acceleration(t);
    height += kStepS * speed;
  }
  return motion;
}

// Tolerance: a pose, and 8 ms because a force with a ramp of 30 ms is seen through a
// window of 50.
TEST(FindFlights, AJumpsTakeOffAndLandingAreFoundToAPose) {
  const Jump jump{1.0, 1.42};
  for (const double rate_hz : {60.0, 100.0, 250.0}) {
    const auto flights = find_flights(jumping(jump, rate_hz, 2.0, 0.0));
    ASSERT_EQ(flights.size(), 1U) << rate_hz;
    EXPECT_NEAR(flights[0].takeoff_s, jump.takeoff_s, 1.0 / rate_hz + 0.008);
    EXPECT_NEAR(flights[0].landing_s, jump.landing_s, 1.0 / rate_hz + 0.008);
    EXPECT_NEAR(flights[0].acceleration_m_s2, -kGravity, 0.01);
  }
}

// The speed at take-off is the integral of the force, 14 * 0.2 + 0.03 * (14 - 9.81) / 2,
// less the fall of 0.9 m/s before: 1.96 m/s, which rises v^2 / 2g. Take-off can be found
// 15 ms late, in which a body at this speed moves 3 cm.
TEST(FindFlights, TheRiseIsThatOfTheCentreOfMass) {
  const auto flights = find_flights(jumping(Jump{1.0, 1.42}, 100.0, 2.0, 0.0));
  ASSERT_EQ(flights.size(), 1U);
  EXPECT_NEAR(flights[0].rise_m, 1.963 * 1.963 / (2.0 * kGravity), 0.03);
}

// 0.1 mm gives 0.5 m/s^2 of the centre's acceleration at 100 Hz.
TEST(FindFlights, NoiseOfATenthOfAMillimetreMovesThemByAPoseAtMost) {
  const Jump jump{1.0, 1.42};
  const auto flights = find_flights(jumping(jump, 100.0, 2.0, 1e-4));
  ASSERT_EQ(flights.size(), 1U);
  EXPECT_NEAR(flights[0].takeoff_s, jump.takeoff_s, 0.018);
  EXPECT_NEAR(flights[0].landing_s, jump.landing_s, 0.018);
}

TEST(FindFlights, FindsNoFlightInStandingOrCrouching) {
  EXPECT_TRUE(find_flights(jumping(Jump{1.0, 1.42}, 100.0, 0.9, 0.0)).empty());
  EXPECT_TRUE(find_flights(jumping(Jump{9.0, 9.4}, 100.0, 2.0, 0.0)).empty());
}

TEST(FindFlights, AFlightThatTheMotionCutsIsLeftOut) {
  EXPECT_TRUE(find_flights(jumping(Jump{1.0, 1.42}, 100.0, 1.3, 0.0)).empty());
  Motion motion = jumping(Jump{1.0, 1.42}, 100.0, 2.0, 0.0);
  motion.poses.erase(motion.poses.begin(), motion.poses.begin() + 110);
  EXPECT_TRUE(find_flights(motion).empty());
  motion.poses.clear();
  EXPECT_TRUE(find_flights(motion).empty());
}

}  // namespace
}  // namespace marey::dynamics
