// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/jumps/find_jumps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/dynamics/jumps/jump_truth.h"

namespace marey::dynamics {
namespace {

// The state at the found time is the true parabola's.
void expect_parabola(const Jump& jump, const MadeFlightTruth& truth, double tolerance_m) {
  const double t = jump.takeoff.time_s - truth.takeoff_s;
  const glm::dvec3 p = truth.takeoff_in_world + t * truth.takeoff_m_s -
                       glm::dvec3(0.0, 0.5 * 9.81 * t * t, 0.0);
  EXPECT_LT(glm::distance(jump.takeoff.p_in_world, p), tolerance_m);
  EXPECT_NEAR(jump.apex_m, truth.apex_m, tolerance_m);
}

TEST(FindJumps, EveryJumpOfAMadeSequenceIsFound) {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const auto flights = marey::testing::random_flights(seed);
    const MadeJumpOptions options = random_jump_options(seed, 60.0);
    const MadeJump made = made_jump(flights, options);
    const auto jumps = find_jumps(made.track);
    const std::string what = "seed " + std::to_string(seed);
    ASSERT_EQ(jumps.size(), made.flights.size()) << what;
    const double size = options.stature_m / 1.75;
    for (std::size_t i = 0; i < jumps.size(); ++i) {
      expect_jump_times(jumps[i], made.flights[i], options, 0.0, what);
      expect_parabola(jumps[i], made.flights[i], 0.005 * size);
      EXPECT_EQ(jumps[i].takeoff_source, Source::kMeasured) << what;
      EXPECT_EQ(jumps[i].landing_source, Source::kMeasured) << what;
      EXPECT_NEAR(jumps[i].lowest_s, made.flights[i].lowest_s, 1.01 / options.rate_hz);
      EXPECT_NEAR(jumps[i].lowest_m, made.flights[i].lowest_m, 0.002 * size) << what;
      EXPECT_NEAR(jumps[i].takeoff_feet_in_world.y, made.flights[i].floor_m, 1e-9);
      ASSERT_TRUE(jumps[i].landing_feet_in_world);
      EXPECT_NEAR(
          jumps[i].landing_feet_in_world->y, made.flights[i].landing_floor_m, 1e-9)
          << what;
    }
    EXPECT_EQ(jumps[0].start_kind, PushStart::kStanding) << what;
    // A countermovement begins slowly: it counts as standing up to 8 cm/s.
    EXPECT_NEAR(jumps[0].start.time_s, made.start_s, 0.25 * std::sqrt(size)) << what;
    ASSERT_TRUE(jumps.back().rest) << what;
    EXPECT_FALSE(jumps.back().rest_is_takeoff) << what;
    EXPECT_LT(jumps.back().rest->time_s, made.rest_s + 0.02) << what;
    for (std::size_t i = 1; i < jumps.size(); ++i) {
      EXPECT_EQ(jumps[i].start_kind, PushStart::kTouchdown) << what;
      EXPECT_EQ(jumps[i].start.time_s, jumps[i - 1].touchdown->time_s) << what;
      if (jumps[i - 1].rest_is_takeoff) {
        EXPECT_EQ(jumps[i - 1].rest->time_s, jumps[i].takeoff.time_s) << what;
      }
    }
  }
}

// 0.5 mm of an adult, on every point of every frame.
TEST(FindJumps, NoiseMovesTheEventsByMilliseconds) {
  int found = 0;
  int expected = 0;
  double sum_ms = 0.0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const auto flights = marey::testing::random_flights(seed);
    MadeJumpOptions options = random_jump_options(seed, 60.0);
    options.rate_hz = std::min(options.rate_hz, 120.0);
    options.noise_m = 0.0005 * options.stature_m / 1.75;
    const MadeJump made = made_jump(flights, options);
    const auto jumps = find_jumps(made.track);
    expected += static_cast<int>(made.flights.size());
    if (jumps.size() != made.flights.size()) continue;
    for (std::size_t i = 0; i < jumps.size(); ++i) {
      ++found;
      expect_jump_times(jumps[i], made.flights[i], options, 0.008, std::to_string(seed));
      sum_ms += 1e3 * std::abs(jumps[i].takeoff.time_s - made.flights[i].takeoff_s);
    }
  }
  EXPECT_EQ(found, expected);
  EXPECT_LT(sum_ms / found, 5.0);
}

TEST(FindJumps, LowRatesFindTheJumpWithAFindingOnTheTimes) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Dice dice(seed);
    MadeJumpOptions options;
    options.rate_hz = dice.between(30.0, 49.0);
    options.standing_s = dice.between(0.5, 0.6);
    const MadeJump made = made_jump({MadeFlight{}}, options);
    const auto jumps = find_jumps(made.track);
    ASSERT_EQ(jumps.size(), 1U) << seed;
    EXPECT_TRUE(has_jump_finding(jumps[0], "rate"));
    const double frame_s = 1.0 / options.rate_hz;
    EXPECT_NEAR(jumps[0].takeoff.time_s, made.flights[0].takeoff_s, frame_s);
    ASSERT_TRUE(jumps[0].touchdown);
    EXPECT_NEAR(jumps[0].touchdown->time_s, made.flights[0].landing_s, frame_s);
  }
}

// Padding changes the foot's mean length, and with it the thresholds, by micrometres.
constexpr double kSame = 2e-4;

void expect_same(const std::vector<Jump>& a,
                 const std::vector<Jump>& b,
                 double later_s,
                 double higher_m,
                 std::uint64_t seed) {
  ASSERT_EQ(a.size(), b.size()) << seed;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i].start.time_s + later_s, b[i].start.time_s, kSame) << seed;
    EXPECT_NEAR(a[i].lowest_s + later_s, b[i].lowest_s, kSame) << seed;
    EXPECT_NEAR(a[i].takeoff.time_s + later_s, b[i].takeoff.time_s, kSame) << seed;
    EXPECT_NEAR(a[i].touchdown->time_s + later_s, b[i].touchdown->time_s, kSame) << seed;
    EXPECT_NEAR(a[i].rest->time_s + later_s, b[i].rest->time_s, kSame) << seed;
    EXPECT_NEAR(a[i].apex_m + higher_m, b[i].apex_m, kSame) << seed;
    EXPECT_NEAR(a[i].takeoff.velocity_m_s.y, b[i].takeoff.velocity_m_s.y, kSame) << seed;
    EXPECT_EQ(a[i].start_kind, b[i].start_kind) << seed;
  }
}

TEST(FindJumps, TimeShiftMirrorHeadingAndFloorLeaveTheAnswer) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    MadeJumpOptions options = random_jump_options(seed, 60.0);
    options.noise_m = 0.0003;
    const MadeJump made = made_jump(marey::testing::random_flights(seed), options);
    const auto jumps = find_jumps(made.track);

    BodyTrack later = made.track;
    const std::size_t frames = 1 + seed % 50;
    const auto delay = [&](std::vector<glm::dvec3>& points) {
      points.insert(points.begin(), frames, points.front());
    };
    delay(later.com_in_world);
    for (SoleTrack& sole : later.soles) {
      delay(sole.heel_in_world);
      delay(sole.ball_in_world);
      delay(sole.tip_in_world);
    }
    expect_same(jumps,
                find_jumps(later),
                static_cast<double>(frames) / options.rate_hz,
                0.0,
                seed);

    BodyTrack mirrored = made.track;
    std::swap(mirrored.soles[0], mirrored.soles[1]);
    for_each_track_point(mirrored,
                         [](const glm::dvec3& p) { return p * glm::dvec3(-1, 1, 1); });
    expect_same(jumps, find_jumps(mirrored), 0.0, 0.0, seed);

    BodyTrack turned = made.track;
    const glm::dquat heading =
        glm::angleAxis(0.1 * static_cast<double>(seed), glm::dvec3(0.0, 1.0, 0.0));
    for_each_track_point(turned, [&](const glm::dvec3& p) { return heading * p; });
    expect_same(jumps, find_jumps(turned), 0.0, 0.0, seed);

    BodyTrack raised = made.track;
    for_each_track_point(raised,
                         [](const glm::dvec3& p) { return p + glm::dvec3(5, 0.7, 0); });
    expect_same(jumps, find_jumps(raised), 0.0, 0.7, seed);
  }
}

}  // namespace
}  // namespace marey::dynamics
