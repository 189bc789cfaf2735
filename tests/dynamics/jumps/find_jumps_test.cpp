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

#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/made_jump.h"

namespace marey::dynamics {
namespace {

using testing::Dice;
using testing::made_jump;
using testing::MadeFlight;
using testing::MadeFlightTruth;
using testing::MadeJump;
using testing::MadeJumpOptions;

MadeJumpOptions random_options(std::uint64_t seed, double min_hz) {
  Dice dice(1000 + seed);
  MadeJumpOptions options;
  options.stature_m = dice.between(0.6, 2.5);
  options.rate_hz = dice.between(min_hz, 240.0);
  options.first_floor_m = dice.between(-0.5, 1.0);
  options.seed = seed;
  return options;
}

bool has_finding(const Jump& jump, const std::string& id) {
  return std::any_of(jump.findings.begin(), jump.findings.end(), [&](const Finding& one) {
    return one.id == id;
  });
}

// A tip leaves at once, with the body's speed: 0.6 of it is reached within 10 ms and a
// frame. A foot counts as landed when its tip is within 15 mm of the floor (of an adult),
// which takes 15 mm divided by the speed.
void expect_times(const Jump& jump,
                  const MadeFlightTruth& truth,
                  const MadeJumpOptions& options,
                  double noise_s,
                  const std::string& what) {
  const double frame_s = 1.0 / options.rate_hz;
  const double size = options.stature_m / 1.75;
  EXPECT_NEAR(jump.takeoff.time_s, truth.takeoff_s, 0.010 + frame_s + noise_s) << what;
  ASSERT_TRUE(jump.touchdown) << what;
  const double early_s = 0.015 * size / std::abs(truth.landing_m_s.y);
  EXPECT_GT(jump.touchdown->time_s, truth.landing_s - early_s - 0.003 - frame_s - noise_s)
      << what;
  EXPECT_LT(jump.touchdown->time_s, truth.landing_s + 0.003 + frame_s + noise_s) << what;
}

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
    const auto flights = testing::random_flights(seed);
    const MadeJumpOptions options = random_options(seed, 60.0);
    const MadeJump made = made_jump(flights, options);
    const auto jumps = find_jumps(made.track);
    const std::string what = "seed " + std::to_string(seed);
    ASSERT_EQ(jumps.size(), made.flights.size()) << what;
    const double size = options.stature_m / 1.75;
    for (std::size_t i = 0; i < jumps.size(); ++i) {
      expect_times(jumps[i], made.flights[i], options, 0.0, what);
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
    const auto flights = testing::random_flights(seed);
    MadeJumpOptions options = random_options(seed, 60.0);
    options.rate_hz = std::min(options.rate_hz, 120.0);
    options.noise_m = 0.0005 * options.stature_m / 1.75;
    const MadeJump made = made_jump(flights, options);
    const auto jumps = find_jumps(made.track);
    expected += static_cast<int>(made.flights.size());
    if (jumps.size() != made.flights.size()) continue;
    for (std::size_t i = 0; i < jumps.size(); ++i) {
      ++found;
      expect_times(jumps[i], made.flights[i], options, 0.008, std::to_string(seed));
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
    EXPECT_TRUE(has_finding(jumps[0], "rate"));
    const double frame_s = 1.0 / options.rate_hz;
    EXPECT_NEAR(jumps[0].takeoff.time_s, made.flights[0].takeoff_s, frame_s);
    ASSERT_TRUE(jumps[0].touchdown);
    EXPECT_NEAR(jumps[0].touchdown->time_s, made.flights[0].landing_s, frame_s);
  }
}

void for_each_point(BodyTrack& track, const auto& change) {
  for (glm::dvec3& p : track.com_in_world) p = change(p);
  for (SoleTrack& sole : track.soles) {
    for (auto* points : {&sole.heel_in_world, &sole.ball_in_world, &sole.tip_in_world}) {
      for (glm::dvec3& p : *points) p = change(p);
    }
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
    MadeJumpOptions options = random_options(seed, 60.0);
    options.noise_m = 0.0003;
    const MadeJump made = made_jump(testing::random_flights(seed), options);
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
    for_each_point(mirrored,
                   [](const glm::dvec3& p) { return p * glm::dvec3(-1, 1, 1); });
    expect_same(jumps, find_jumps(mirrored), 0.0, 0.0, seed);

    BodyTrack turned = made.track;
    const glm::dquat heading =
        glm::angleAxis(0.1 * static_cast<double>(seed), glm::dvec3(0.0, 1.0, 0.0));
    for_each_point(turned, [&](const glm::dvec3& p) { return heading * p; });
    expect_same(jumps, find_jumps(turned), 0.0, 0.0, seed);

    BodyTrack raised = made.track;
    for_each_point(raised, [](const glm::dvec3& p) { return p + glm::dvec3(5, 0.7, 0); });
    expect_same(jumps, find_jumps(raised), 0.0, 0.7, seed);
  }
}

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
  EXPECT_TRUE(has_finding(jumps[0], "cut"));
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
  EXPECT_TRUE(has_finding(jumps[0], "clip-start"));
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
  ASSERT_TRUE(has_finding(jumps[0], "gravity"));
  EXPECT_NE(jumps[0].findings[0].message().find("falls at -12"), std::string::npos);
  FindJumpsOptions expected;
  expected.expected_fall_m_s2 = 12.2;
  const auto scaled = find_jumps(made.track, expected);
  ASSERT_EQ(scaled.size(), 1U);
  EXPECT_FALSE(has_finding(scaled[0], "gravity"));
  EXPECT_EQ(scaled[0].gravity_m_s2, 12.2);
}

// All lengths doubled at the same times: the body falls at 19.62 m/s^2.
TEST(FindJumps, AScaledMotionIsSearchedAtItsScaledFall) {
  for (const double scale : {0.4, 2.0}) {
    const MadeJump made = made_jump({MadeFlight{}});
    BodyTrack track = made.track;
    for_each_point(track, [&](const glm::dvec3& p) { return scale * p; });
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
  EXPECT_TRUE(has_finding(jumps[0], "inferred"));
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
    MadeJumpOptions options = random_options(seed, 60.0);
    options.one_footed = true;
    const MadeJump made = made_jump(testing::random_flights(seed), options);
    const auto jumps = find_jumps(made.track);
    ASSERT_EQ(jumps.size(), made.flights.size()) << seed;
    for (std::size_t i = 0; i < jumps.size(); ++i) {
      expect_times(jumps[i], made.flights[i], options, 0.0, std::to_string(seed));
      EXPECT_GT(jumps[i].takeoff_feet_in_world.x, 0.0) << seed;
      EXPECT_NEAR(jumps[i].takeoff_feet_in_world.y, made.flights[i].floor_m, 1e-9);
    }
  }
}

TEST(FindJumpsDeathTest, NonFinitePositionsBreakTheContract) {
  MadeJump made = made_jump({MadeFlight{}});
  made.track.com_in_world[10].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_DEATH((void)find_jumps(made.track), "contract broken");
}

}  // namespace
}  // namespace marey::dynamics
