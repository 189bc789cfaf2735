// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "dynamics/jumps/find_jumps.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/dynamics/jumps/jump_truth.h"

namespace marey::dynamics {
namespace {

TEST(FindJumps, AMotionWithoutFlightHasNoJumps) {
  // Standing still, and too short to have a velocity.
  BodyTrack still;
  still.rate = FrameRate{100.0};
  EXPECT_TRUE(find_jumps(still).empty());
  still.com_in_world.assign(2, glm::dvec3(0.0, 1.0, 0.0));
  EXPECT_TRUE(find_jumps(still).empty());
  still.com_in_world.assign(300, glm::dvec3(0.0, 1.0, 0.0));
  EXPECT_TRUE(find_jumps(still).empty());
  // Swimming: the body bobs, the soles are never on a floor.
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Dice dice(seed);
    BodyTrack swimmer;
    swimmer.rate = FrameRate{dice.between(30.0, 240.0)};
    const double hz = dice.between(0.3, 0.7);
    for (int i = 0; i < 600; ++i) {
      const double t = i / swimmer.rate.hz;
      const double phase = 6.283185307 * hz * t;
      swimmer.com_in_world.emplace_back(t, -0.2 + 0.15 * std::sin(phase), 0.0);
      for (std::size_t side = 0; side < 2; ++side) {
        const double kick =
            0.2 * std::sin(8.0 * phase + 3.14159 * static_cast<double>(side));
        const glm::dvec3 foot(t - 0.9, -0.3 + kick, 0.1);
        swimmer.soles[side].heel_in_world.push_back(foot);
        swimmer.soles[side].ball_in_world.push_back(foot + glm::dvec3(-0.15, -0.02, 0.0));
        swimmer.soles[side].tip_in_world.push_back(foot + glm::dvec3(-0.23, -0.03, 0.0));
      }
    }
    EXPECT_TRUE(find_jumps(swimmer).empty()) << seed;
  }
}

// The body drops into a squat at 0.9 g for 0.15 s while its feet stay on the floor.
TEST(FindJumps, AFastSquatIsNoJump) {
  BodyTrack squat;
  squat.rate = FrameRate{100.0};
  double y = 1.0;
  double speed = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double t = i / 100.0;
    const double a = t < 0.5 ? 0.0 : t < 0.65 ? -8.9 : t < 0.80 ? 8.9 : 0.0;
    speed += a / 100.0;
    y += speed / 100.0;
    squat.com_in_world.emplace_back(0.0, y, 0.0);
    for (SoleTrack& sole : squat.soles) {
      sole.heel_in_world.emplace_back(0.0, 0.0, -0.1);
      sole.ball_in_world.emplace_back(0.0, 0.0, 0.08);
      sole.tip_in_world.emplace_back(0.0, 0.0, 0.15);
    }
  }
  EXPECT_TRUE(find_jumps(squat).empty());
}

void keep_frames(BodyTrack& track, std::size_t first, std::size_t count) {
  const auto cut = [&](std::vector<glm::dvec3>& points) {
    const auto from = points.begin() + static_cast<std::ptrdiff_t>(first);
    points = {from, from + static_cast<std::ptrdiff_t>(count)};
  };
  cut(track.com_in_world);
  for (SoleTrack& sole : track.soles) {
    cut(sole.heel_in_world);
    cut(sole.ball_in_world);
    cut(sole.tip_in_world);
  }
}

TEST(FindJumps, AClipThatEndsInFlightHasATakeOffOnly) {
  const MadeJump made = made_jump({MadeFlight{}});
  BodyTrack track = made.track;
  const auto middle = static_cast<std::size_t>(
      0.5 * (made.flights[0].takeoff_s + made.flights[0].landing_s) * track.rate.hz);
  keep_frames(track, 0, middle);
  const auto jumps = find_jumps(track);
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_NEAR(jumps[0].takeoff.time_s, made.flights[0].takeoff_s, 0.015);
  EXPECT_FALSE(jumps[0].touchdown);
  EXPECT_FALSE(jumps[0].rest);
  EXPECT_FALSE(jumps[0].landing_feet_in_world);
  EXPECT_TRUE(has_jump_finding(jumps[0], "cut"));
}

TEST(FindJumps, AFlightBeforeTheClipIsTheStartOfTheNextPush) {
  const MadeJump made = made_jump({MadeFlight{}, MadeFlight{}});
  BodyTrack track = made.track;
  const double cut_s = 0.5 * (made.flights[0].takeoff_s + made.flights[0].landing_s);
  const auto first = static_cast<std::size_t>(cut_s * track.rate.hz);
  keep_frames(track, first, track.com_in_world.size() - first);
  const double from_s = static_cast<double>(first) / track.rate.hz;
  const auto jumps = find_jumps(track);
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_EQ(jumps[0].start_kind, PushStart::kTouchdown);
  EXPECT_NEAR(jumps[0].start.time_s + from_s, made.flights[0].landing_s, 0.015);
}

TEST(FindJumps, AClipThatBeginsInThePushHasAFinding) {
  const MadeJump made = made_jump({MadeFlight{}});
  BodyTrack track = made.track;
  const auto first =
      static_cast<std::size_t>((made.flights[0].lowest_s - 0.2) * track.rate.hz);
  keep_frames(track, first, track.com_in_world.size() - first);
  const auto jumps = find_jumps(track);
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_EQ(jumps[0].start_kind, PushStart::kClipStart);
  EXPECT_EQ(jumps[0].start.time_s, 0.0);
  EXPECT_TRUE(has_jump_finding(jumps[0], "clip-start"));
}

TEST(FindJumps, TheUserSetsTheStartOfThePush) {
  const MadeJump made = made_jump({MadeFlight{}, MadeFlight{}});
  FindJumpsOptions options;
  options.start_s = 0.5 * (made.flights[0].landing_s + made.flights[1].lowest_s);
  const auto jumps = find_jumps(made.track, options);
  ASSERT_EQ(jumps.size(), 2U);
  EXPECT_EQ(jumps[0].start_kind, PushStart::kStanding);
  EXPECT_EQ(jumps[1].start_kind, PushStart::kGiven);
  EXPECT_EQ(jumps[1].start.time_s, *options.start_s);
}

TEST(FindJumps, AFlightThatFallsTooFastHasAFinding) {
  MadeJumpOptions options;
  options.gravity_m_s2 = 12.2;
  const MadeJump made = made_jump({MadeFlight{}}, options);
  const auto jumps = find_jumps(made.track);
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_NEAR(jumps[0].fall_m_s2, -12.2, 0.3);
  EXPECT_EQ(jumps[0].gravity_m_s2, -jumps[0].fall_m_s2);
  ASSERT_TRUE(has_jump_finding(jumps[0], "gravity"));
  EXPECT_NE(jumps[0].findings[0].message().find("falls at -12"), std::string::npos);
  FindJumpsOptions expected;
  expected.expected_fall_m_s2 = 12.2;
  const auto scaled = find_jumps(made.track, expected);
  ASSERT_EQ(scaled.size(), 1U);
  EXPECT_FALSE(has_jump_finding(scaled[0], "gravity"));
  EXPECT_EQ(scaled[0].gravity_m_s2, 12.2);
}

// All lengths doubled at the same times: the body falls at 19.62 m/s^2.
TEST(FindJumps, AScaledMotionIsSearchedAtItsScaledFall) {
  for (const double scale : {0.4, 2.0}) {
    const MadeJump made = made_jump({MadeFlight{}});
    BodyTrack track = made.track;
    for_each_track_point(track, [&](const glm::dvec3& p) { return scale * p; });
    FindJumpsOptions options;
    options.expected_fall_m_s2 = scale * 9.81;
    const auto jumps = find_jumps(track, options);
    const auto plain = find_jumps(made.track);
    ASSERT_EQ(jumps.size(), 1U) << scale;
    EXPECT_NEAR(jumps[0].takeoff.time_s, plain[0].takeoff.time_s, 1e-9);
    EXPECT_NEAR(jumps[0].touchdown->time_s, plain[0].touchdown->time_s, 1e-9);
    EXPECT_NEAR(jumps[0].rise_m(), scale * plain[0].rise_m(), 1e-9);
    EXPECT_TRUE(jumps[0].findings.empty());
  }
}

TEST(FindJumps, UnknownFeetGiveInferredTimes) {
  MadeJump made = made_jump({MadeFlight{}});
  for (SoleTrack& sole : made.track.soles) sole = {};
  const auto jumps = find_jumps(made.track);
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_EQ(jumps[0].takeoff_source, Source::kInferred);
  EXPECT_EQ(jumps[0].landing_source, Source::kInferred);
  EXPECT_TRUE(has_jump_finding(jumps[0], "inferred"));
  EXPECT_NEAR(jumps[0].takeoff.time_s, made.flights[0].takeoff_s, 0.03);
  EXPECT_NEAR(jumps[0].touchdown->time_s, made.flights[0].landing_s, 0.03);
}

// Feet on another clock than the body: 80 ms late.
TEST(FindJumps, FeetThatDisagreeWithTheBodyAreNotUsed) {
  MadeJump made = made_jump({MadeFlight{}});
  const auto frames = static_cast<std::ptrdiff_t>(0.08 * made.track.rate.hz);
  for (SoleTrack& sole : made.track.soles) {
    for (auto* points : {&sole.heel_in_world, &sole.ball_in_world, &sole.tip_in_world}) {
      points->insert(points->begin(), static_cast<std::size_t>(frames), points->front());
      points->resize(made.track.com_in_world.size());
    }
  }
  const auto jumps = find_jumps(made.track);
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_EQ(jumps[0].takeoff_source, Source::kInferred);
  EXPECT_EQ(jumps[0].landing_source, Source::kInferred);
  EXPECT_NEAR(jumps[0].takeoff.time_s, made.flights[0].takeoff_s, 0.03);
}

TEST(FindJumps, OneFootedJumpsStandOnThatFoot) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    MadeJumpOptions options = random_jump_options(seed, 60.0);
    options.one_footed = true;
    const MadeJump made = made_jump(marey::testing::random_flights(seed), options);
    const auto jumps = find_jumps(made.track);
    ASSERT_EQ(jumps.size(), made.flights.size()) << seed;
    for (std::size_t i = 0; i < jumps.size(); ++i) {
      expect_jump_times(jumps[i], made.flights[i], options, 0.0, std::to_string(seed));
      EXPECT_GT(jumps[i].takeoff_feet_in_world.x, 0.0) << seed;
      EXPECT_NEAR(jumps[i].takeoff_feet_in_world.y, made.flights[i].floor_m, 1e-9);
    }
  }
}

TEST(FindJumps, ASomersaultHasTheSameEvents) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    MadeJumpOptions options = random_jump_options(seed, 100.0);
    options.somersault = true;
    MadeFlight flight;
    flight.up_m_s = 3.0;
    const MadeJump made = made_jump({flight}, options);
    const auto jumps = find_jumps(made.track);
    ASSERT_EQ(jumps.size(), 1U) << seed;
    expect_jump_times(jumps[0], made.flights[0], options, 0.005, std::to_string(seed));
  }
}

TEST(FindJumpsDeathTest, NonFinitePositionsBreakTheContract) {
  MadeJump made = made_jump({MadeFlight{}});
  made.track.com_in_world[10].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_DEATH((void)find_jumps(made.track), "contract broken");
}

}  // namespace
}  // namespace marey::dynamics
