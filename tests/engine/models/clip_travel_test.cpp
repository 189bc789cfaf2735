// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/clip_travel.h"

#include <cmath>
#include <cstdint>
#include <string>

#include "engine/models/swing_curve.h"
#include <gtest/gtest.h>

#include "tests/engine/models/made_walker.h"

namespace marey::engine {
namespace {

TEST(ClipTravel, MeasuresAStraightWalk) {
  const MadeWalker walker(Gait{});
  const auto travel = travel_of_clip(walker.clip());
  ASSERT_TRUE(travel);
  EXPECT_TRUE(travel->travels);
  EXPECT_EQ(travel->steps.size(), 2U);
  EXPECT_NEAR(travel->cycle_s, 1.1, 1e-6);
  EXPECT_NEAR(travel->distance_legs, 1.5, 1e-5);
  EXPECT_NEAR(travel->direction_rad, 0.0, 1e-3);
  EXPECT_NEAR(travel->speed_legs_s, 1.5 / 1.1, 1e-5);
  EXPECT_NEAR(travel->mean_alone_s, 0.7 * 0.55, 1e-5);
  EXPECT_NEAR(travel->mean_step_legs, 0.75, 1e-4);
}

TEST(ClipTravel, MeasuresTheDirectionOfASidewaysWalk) {
  const MadeWalker walker(Gait{.travel_rad = 1.4});
  const auto travel = travel_of_clip(walker.clip());
  ASSERT_TRUE(travel);
  EXPECT_NEAR(travel->direction_rad, 1.4, 2e-3);
  // The heading sways by 0.08 rad; the direction of a cycle does not.
  for (const double time_s : {0.0, 0.3, 0.8, 5.0}) {
    const double course_rad = path_at(walker.clip(), time_s).heading_rad +
                              travel_direction(walker.clip(), *travel, time_s);
    EXPECT_NEAR(course_rad, 0.0, 2e-3);
  }
}

TEST(ClipTravel, MeasuresTheTurnOfACurvedWalk) {
  const MadeWalker walker(Gait{.turn_rad = 0.1});
  const auto travel = travel_of_clip(walker.clip());
  ASSERT_TRUE(travel);
  EXPECT_NEAR(travel->turn_rad, 0.2, 1e-5);
  EXPECT_NEAR(travel->steps[0].turn_rad + travel->steps[1].turn_rad, 0.2, 1e-4);
}

TEST(ClipTravel, FindsTheStepsOfARun) {
  const MadeWalker walker(
      Gait{.step_legs = 1.35, .step_s = 0.36, .alone_share = 0.45, .runs = true});
  const auto travel = travel_of_clip(walker.clip());
  ASSERT_TRUE(travel);
  ASSERT_EQ(travel->steps.size(), 2U);
  for (const ClipStep& step : travel->steps) {
    EXPECT_NEAR(step.alone_end_s - step.alone_start_s, 0.45 * 0.36, 1e-5);
    EXPECT_NEAR(step.land_s - step.alone_start_s, 0.36, 1e-5);
    EXPECT_NEAR(step.along_legs, 1.35, 1e-3);
  }
}

TEST(ClipTravel, ADanceOnTheSpotHasNoDirection) {
  const MadeWalker walker(Gait{.steps = 4, .step_legs = 0.4, .stays = true});
  const auto travel = travel_of_clip(walker.clip());
  ASSERT_TRUE(travel);
  EXPECT_FALSE(travel->travels);
  EXPECT_EQ(travel_direction(walker.clip(), *travel, 0.3), 0.0);
}

TEST(ClipTravel, RefusesClipsWithoutStepsByName) {
  MotionClip clip = MadeWalker(Gait{}).clip();
  clip.loops = false;
  auto travel = travel_of_clip(clip);
  ASSERT_FALSE(travel);
  EXPECT_NE(travel.error().message().find("made"), std::string::npos);
  clip.loops = true;
  clip.contacts = {};
  EXPECT_FALSE(travel_of_clip(clip));
  const ClipSpan all{0.0F, static_cast<float>(clip.duration_s())};
  clip.contacts.fill({all});
  EXPECT_FALSE(travel_of_clip(clip));
}

TEST(SwingCurve, PermitsTheTargetsThatKeepItsLimits) {
  for (std::uint32_t seed = 0; seed < 500; ++seed) {
    MadeNumbers numbers(seed);
    SwingCurve curve;
    curve.hold(0.0);
    double target = numbers.next(-0.2, 0.2);
    double now_s = 0.0;
    curve.bend(0.0, 0.45, target);
    for (int i = 0; i < 3; ++i) {
      now_s += numbers.next(0.0, 0.08);
      const double end_s = numbers.next(0.4, 0.5);
      const CurveRange range =
          permitted_targets(curve.at(now_s), end_s - now_s, 0.6, 2.0);
      ASSERT_LE(range.low, range.high);
      const CurvePoint before = curve.at(now_s);
      curve.bend(now_s, end_s, numbers.next(range.low, range.high));
      const CurvePoint after = curve.at(now_s);
      EXPECT_NEAR(before.value, after.value, 1e-12);
      EXPECT_NEAR(before.rate, after.rate, 1e-10);
      EXPECT_NEAR(before.acceleration, after.acceleration, 1e-8);
    }
    for (double t = now_s; t < 0.6; t += 0.001) {
      EXPECT_LE(std::abs(curve.at(t).rate), 2.0);
      EXPECT_LE(std::abs(curve.at(t).value), 0.6 * 1.001);
    }
    EXPECT_EQ(curve.at(0.6).value, curve.target());
  }
}

}  // namespace
}  // namespace marey::engine
