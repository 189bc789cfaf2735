// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/steer_course.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "engine/models/steer_plan.h"
#include <gtest/gtest.h>

#include "tests/engine/models/made_walker.h"

namespace marey::engine {
namespace {

constexpr double kHalfTurn_rad = 3.14159265358979323846;
constexpr double kDegree_rad = kHalfTurn_rad / 180.0;

struct NamedGait {
  std::string name;
  Gait gait;
  double nearest_m = 1.5;
  double farthest_m = 9.0;
};

std::vector<NamedGait> all_gaits() {
  return {
      {"walk", {}},
      {"curved", {.turn_rad = 0.06}},
      {"sideways", {.step_legs = 0.35, .travel_rad = 1.4}},
      {"backwards", {.step_legs = 0.5, .travel_rad = 3.1}},
      {"drunk", {.steps = 8, .step_legs = 0.5, .sway_legs = 0.2, .irregular = 0.4}},
      {"run",
       {.step_legs = 1.35, .step_s = 0.36, .alone_share = 0.45, .runs = true},
       8.0,
       25.0},
  };
}

struct Trial {
  WalkOptions options;
  glm::dvec2 goal_xz_m{0.0};
};

Trial make_trial(const NamedGait& gait, std::uint32_t seed) {
  MadeNumbers numbers(seed + 100);
  const double direction_rad = numbers.next(-kHalfTurn_rad, kHalfTurn_rad);
  const double distance_m = numbers.next(gait.nearest_m, gait.farthest_m);
  Trial trial;
  RootPlace& start = trial.options.start;
  start = {numbers.next(-3, 3), numbers.next(-3, 3), numbers.next(-3, 3)};
  trial.options.start_clip_s = numbers.next(0.0, 1.0);
  trial.goal_xz_m = {start.x_m + distance_m * std::sin(direction_rad),
                     start.z_m + distance_m * std::cos(direction_rad)};
  return trial;
}

Walked walk_to(const MadeWalker& walker,
               const GoalAt& goal,
               const WalkOptions& options,
               const SteerSettings& settings = {}) {
  const ClipTravel travel = *travel_of_clip(walker.clip());
  SteerCourse course;
  EXPECT_TRUE(course.start(walker.clip(), travel, settings));
  return walk(walker, course, goal, options);
}

void expect_limits(const Walked& walked, const std::string& what) {
  EXPECT_LE(walked.max_turn_rad, 35.0 * kDegree_rad + 1e-9) << what;
  EXPECT_LE(walked.max_turn_rad_s, 120.0 * kDegree_rad) << what;
  EXPECT_EQ(walked.turn_with_both_rad, 0.0) << what;
  // Contacts and path of the clip are in single precision.
  EXPECT_LT(walked.foot_error_m, 2e-6) << what;
  EXPECT_LE(walked.max_twist_rad, 35.0 * kDegree_rad + 1e-9) << what;
  EXPECT_LT(walked.twist_error_rad, 1e-9) << what;
}

TEST(SteerCourse, ArrivesWithinItsLimitsFromAnywhere) {
  for (const NamedGait& named : all_gaits()) {
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
      Gait gait = named.gait;
      gait.seed = seed + 1;
      const MadeWalker walker(gait);
      const Trial trial = make_trial(named, seed);
      const Walked walked = walk_to(
          walker, [&](double) { return trial.goal_xz_m; }, trial.options);
      const std::string what = named.name + " " + std::to_string(seed);
      EXPECT_TRUE(walked.arrived) << what;
      EXPECT_LE(walked.distance_m, 0.2) << what;
      expect_limits(walked, what);
      if (gait.irregular == 0.0) {
        EXPECT_LE(walked.max_shift_of_step, 0.305) << what;
      }
    }
  }
}

TEST(SteerCourse, FollowsAGoalThatJumpsThreeTimes) {
  for (const NamedGait& named : all_gaits()) {
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
      Gait gait = named.gait;
      gait.seed = seed + 1;
      const MadeWalker walker(gait);
      MadeNumbers numbers(seed);
      std::vector<glm::dvec2> goals;
      for (int i = 0; i < 4; ++i) {
        const double far_m = named.farthest_m;
        goals.emplace_back(numbers.next(-far_m, far_m), numbers.next(-far_m, far_m));
      }
      const double each_s = numbers.next(1.0, 2.0);
      const auto goal = [&](double time_s) {
        return goals[static_cast<std::size_t>(std::min(time_s / each_s, 3.0))];
      };
      const Walked walked = walk_to(walker, goal, {});
      const std::string what = named.name + " " + std::to_string(seed);
      if (walked.duration_s < 3.0 * each_s) continue;  // At an earlier goal already.
      EXPECT_TRUE(walked.arrived) << what;
      EXPECT_LE(walked.distance_m, 0.2) << what;
      expect_limits(walked, what);
    }
  }
}

TEST(SteerCourse, ReachesAGoalBehind) {
  const MadeWalker walker(Gait{});
  for (const double distance_m : {2.0, 5.0}) {
    const Walked walked = walk_to(walker,
                                  [&](double) {
                                    return glm::dvec2{0.0, -distance_m};
                                  },
                                  {});
    EXPECT_TRUE(walked.arrived);
    EXPECT_LE(walked.distance_m, 0.2);
    expect_limits(walked, "behind");
  }
}

TEST(SteerCourse, ReachesAGoalWithinOneStep) {
  const MadeWalker walker(Gait{});
  for (const double distance_m : {0.5, 0.7, 0.85}) {
    const Walked walked = walk_to(walker,
                                  [&](double) {
                                    return glm::dvec2{0.0, distance_m};
                                  },
                                  {});
    EXPECT_TRUE(walked.arrived);
    EXPECT_LE(walked.distance_m, 0.2);
    EXPECT_LE(walked.landings, 2);
  }
}

TEST(SteerCourse, HasArrivedAtItsOwnPlace) {
  const MadeWalker walker(Gait{});
  const Walked walked = walk_to(walker, [](double) { return glm::dvec2{0.0, 0.0}; }, {});
  EXPECT_TRUE(walked.arrived);
  EXPECT_EQ(walked.duration_s, 0.0);
}

TEST(SteerCourse, ReportsAGoalThatItDoesNotReachInTime) {
  const MadeWalker walker(Gait{});
  SteerSettings settings;
  settings.max_duration_s = 5.0;
  const glm::dvec2 goal{0.0, 50.0};
  const Walked walked = walk_to(
      walker, [&](double) { return goal; }, {}, settings);
  EXPECT_FALSE(walked.arrived);
  EXPECT_EQ(walked.steps.back().out.state, SteerState::kOutOfTime);
  EXPECT_NEAR(walked.duration_s, 5.0, 0.6 /* s, a step */);
  const ClipTravel travel = *travel_of_clip(walker.clip());
  const auto answer = ask_steer(walker.clip(), travel, {.goal_xz_m = goal}, settings);
  ASSERT_TRUE(answer);
  EXPECT_FALSE(answer->reachable);
  EXPECT_EQ(*steps_to(walker.clip(), travel, {.goal_xz_m = goal}, settings), -1);
}

TEST(SteerCourse, RefusesGoalsThatAreNotFinite) {
  const MadeWalker walker(Gait{});
  const ClipTravel travel = *travel_of_clip(walker.clip());
  SteerCourse course;
  ASSERT_TRUE(course.start(walker.clip(), travel));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(course.aim({nan, 0.0}));
  EXPECT_FALSE(course.aim({0.0, std::numeric_limits<double>::infinity()}));
  EXPECT_FALSE(ask_steer(walker.clip(), travel, {.goal_xz_m = {nan, 0.0}}));
  EXPECT_FALSE(ask_steer(walker.clip(), travel, {.rate = 0.0}));
  SteerSettings settings;
  settings.min_scale = 0.0;
  EXPECT_FALSE(course.start(walker.clip(), travel, settings));
}

// The change of the turn's acceleration from step to step: a jump would not shrink with
// the step.
TEST(SteerCourse, TurnsWithContinuousAcceleration) {
  const MadeWalker walker(Gait{});
  std::vector<double> worst;
  for (const double step_s : {1.0 / 240.0, 1.0 / 480.0, 1.0 / 960.0}) {
    WalkOptions options;
    options.step_s = step_s;
    // The goal jumps within a swing, early enough to replan it.
    const auto goal = [](double time_s) {
      return time_s < 0.75 ? glm::dvec2{4.0, 4.0} : glm::dvec2{-1.0, 5.0};
    };
    const Walked walked = walk_to(walker, goal, options);
    EXPECT_TRUE(walked.arrived);
    double largest = 0.0;
    for (std::size_t i = 2; i < walked.steps.size(); ++i) {
      const double third = walked.steps[i].out.turn_rad -
                           2.0 * walked.steps[i - 1].out.turn_rad +
                           walked.steps[i - 2].out.turn_rad;
      largest = std::max(largest, std::abs(third) / (step_s * step_s));
    }
    worst.push_back(largest);
  }
  // Change of the acceleration over a step: halves with the step if it is continuous.
  EXPECT_LT(worst[1], 0.6 * worst[0]);
  EXPECT_LT(worst[2], 0.6 * worst[1]);
}

TEST(SteerCourse, KeepsTheFootprintOfASwingThatEndsSoon) {
  const MadeWalker walker(Gait{});
  // The second swing lasts from 0.715 s to 1.1 s.
  const auto turn_of_swing = [&](double jump_s) {
    const auto goal = [&](double time_s) {
      return time_s < jump_s ? glm::dvec2{4.0, 4.0} : glm::dvec2{-4.0, 4.0};
    };
    const Walked walked = walk_to(walker, goal, {});
    double turn_rad = 0.0;
    for (const WalkedStep& step : walked.steps) {
      if (step.time_s > 0.6 && step.time_s < 1.1) turn_rad += step.out.turn_rad;
    }
    return turn_rad;
  };
  const double kept = turn_of_swing(1e9);
  EXPECT_EQ(turn_of_swing(1.0), kept);
  EXPECT_NE(turn_of_swing(0.8), kept);
}

TEST(SteerCourse, MirrorsItsCourseWithTheGoal) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    Gait gait{.sway_legs = 0.05, .turn_rad = 0.02};
    const MadeWalker walker(gait);
    gait.mirrored = true;
    const MadeWalker mirrored(gait);
    MadeNumbers numbers(seed);
    glm::dvec2 goal{numbers.next(-6, 6), numbers.next(-6, 6)};
    if (seed == 0) goal = {0.0, -4.0};
    const Walked a = walk_to(walker, [&](double) { return goal; }, {});
    const Walked b = walk_to(mirrored,
                             [&](double) {
                               return glm::dvec2{-goal.x, goal.y};
                             },
                             {});
    ASSERT_EQ(a.steps.size(), b.steps.size()) << seed;
    for (std::size_t i = 0; i < a.steps.size(); ++i) {
      ASSERT_NEAR(a.steps[i].root.x_m, -b.steps[i].root.x_m, 1e-4) << seed;
      ASSERT_NEAR(a.steps[i].root.z_m, b.steps[i].root.z_m, 1e-4) << seed;
    }
  }
}

TEST(SteerCourse, FollowsClipsAtOtherRatesAndSteps) {
  for (const double rate : {0.6, 1.5}) {
    for (const double step_s : {1.0 / 30.0, 1.0 / 120.0}) {
      for (std::uint32_t seed = 0; seed < 20; ++seed) {
        const NamedGait named{"walk", {}};
        const MadeWalker walker(named.gait);
        Trial trial = make_trial(named, seed);
        trial.options.rate = rate;
        trial.options.step_s = step_s;
        const Walked walked = walk_to(
            walker, [&](double) { return trial.goal_xz_m; }, trial.options);
        EXPECT_TRUE(walked.arrived);
        EXPECT_LE(walked.distance_m, 0.2);
        expect_limits(walked, "rate");
      }
    }
  }
}

TEST(SteerCourse, PredictsStepsAndDurationOfMostCourses) {
  int close = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const NamedGait named{"walk", {}};
    const MadeWalker walker(named.gait);
    const ClipTravel travel = *travel_of_clip(walker.clip());
    const Trial trial = make_trial(named, seed);
    const WalkOptions& options = trial.options;
    const auto answer = ask_steer(walker.clip(),
                                  travel,
                                  {options.start,
                                   options.start_clip_s,
                                   options.rate,
                                   options.leg_length_m,
                                   trial.goal_xz_m});
    ASSERT_TRUE(answer);
    EXPECT_TRUE(answer->reachable);
    const Walked walked = walk_to(
        walker, [&](double) { return trial.goal_xz_m; }, options);
    if (std::abs(answer->steps - walked.landings) <= 1 &&
        std::abs(answer->duration_s - walked.duration_s) <= 0.6) {
      ++close;
    }
  }
  EXPECT_GE(close, 190);
}

TEST(SteerCourse, TurnsTheRootAboutAFoot) {
  const RootPlace root{1.0, 2.0, 0.3};
  const RootPlace turned_root = turn_about(root, {1.0, 1.0}, kHalfTurn_rad / 2.0);
  EXPECT_NEAR(turned_root.x_m, 2.0, 1e-12);  // From +Z towards +X.
  EXPECT_NEAR(turned_root.z_m, 1.0, 1e-12);
  EXPECT_NEAR(turned_root.heading_rad, 0.3 + kHalfTurn_rad / 2.0, 1e-12);
}

}  // namespace
}  // namespace marey::engine
