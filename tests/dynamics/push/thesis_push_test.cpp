// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/push/thesis_push.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/dynamics/push/linear_push.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/count_allocations.h"

namespace marey::dynamics {
namespace {

using testing::Dice;
using testing::LinearPush;

/// Ends of all kinds, many of which have no push.
PushEnds any_thesis_ends(Dice& dice) {
  PushEnds ends;
  ends.start_m = dice.between(0.5, 1.3);
  ends.start_m_s = dice.between(-3.0, 1.0);
  ends.end_m = ends.start_m + dice.between(-0.3, 0.3);
  ends.end_m_s = dice.between(-1.0, 4.0);
  ends.duration_s = dice.between(0.1, 2.0);
  if (dice.between(0.0, 1.0) < 0.7) ends.start_m_s2 = dice.between(-9.81, 30.0);
  if (dice.between(0.0, 1.0) < 0.7) ends.end_m_s2 = dice.between(-9.81, 30.0);
  return ends;
}

/// Ends of figure 6.6: from rest to a take-off of 2.43 m/s.
PushEnds thesis_jump() {
  PushEnds ends;
  ends.end_m = 0.08;
  ends.end_m_s = 2.43;
  ends.duration_s = 0.7;
  return ends;
}

TEST(ThesisPush, EqualsTheLinearSystemToABillionth) {
  Dice dice(61);
  double worst = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const PushEnds ends = any_thesis_ends(dice);
    const double s = dice.between(0.05, 0.95);
    const double z = ends.start_m + dice.between(-0.6, 0.1);
    const auto push = thesis_push(ends, s, z);
    ASSERT_TRUE(push);
    const LinearPush truth = testing::linear_push(ends, s, z);
    long double largest = 0.0L;
    for (const long double c : truth) largest = std::max(largest, std::abs(c));
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const long double error = push->coefficients_m[i] - truth[i];
      worst = std::max(worst, static_cast<double>(std::abs(error) / largest));
    }
  }
  EXPECT_LT(worst, 1e-9);
}

TEST(ThesisPush, HasTheStatesOfItsEndsAndRestsAtItsLowestPoint) {
  Dice dice(62);
  for (int k = 0; k < 500; ++k) {
    const PushEnds ends = any_thesis_ends(dice);
    const double s = dice.between(0.2, 0.8);
    const double z = ends.start_m + dice.between(-0.6, 0.1);
    const auto push = thesis_push(ends, s, z);
    ASSERT_TRUE(push);
    const double t = ends.duration_s;
    const double g = ends.gravity_m_s2;
    EXPECT_EQ(push->height_m(0.0), ends.start_m);
    EXPECT_NEAR(push->velocity_m_s(0.0), ends.start_m_s, 1e-12);
    EXPECT_NEAR(push->force_m_s2(0.0), ends.start_m_s2.value_or(0.0) + g, 1e-11);
    EXPECT_NEAR(push->height_m(s * t), z, 1e-10);
    EXPECT_NEAR(push->velocity_m_s(s * t), 0.0, 1e-9);
    EXPECT_NEAR(push->height_m(t), ends.end_m, 1e-10);
    EXPECT_NEAR(push->velocity_m_s(t), ends.end_m_s, 1e-8);
    EXPECT_NEAR(push->force_m_s2(t), ends.end_m_s2.value_or(0.0) + g, 1e-6);
  }
}

// The derivatives of the struct are those of its own height.
TEST(ThesisPush, VelocityAndForceAreDerivativesOfTheHeight) {
  const auto push = thesis_push(thesis_jump(), 0.6, -0.25);
  ASSERT_TRUE(push);
  constexpr double kStep_s = 1e-4;
  for (double t = 0.05; t < 0.65; t += 0.01) {
    const double before = push->height_m(t - kStep_s);
    const double here = push->height_m(t);
    const double after = push->height_m(t + kStep_s);
    EXPECT_NEAR(push->velocity_m_s(t), (after - before) / (2.0 * kStep_s), 1e-4);
    EXPECT_NEAR(push->force_m_s2(t) - 9.81,
                (after - 2.0 * here + before) / (kStep_s * kStep_s),
                1e-2);
  }
}

// A measured end below free fall would leave no push: the force at that end is negative
// whatever the lowest point. It counts as free fall instead.
TEST(ThesisPush, EndsBelowFreeFallCountAsFreeFall) {
  PushEnds measured = thesis_jump();
  measured.end_m_s2 = -10.0;
  PushEnds free_fall = thesis_jump();
  free_fall.end_m_s2 = -9.81;
  const double t2 = measured.duration_s * measured.duration_s;
  for (double s = 0.05; s < 1.0; s += 0.05) {
    for (double z = -0.6; z < 0.1; z += 0.05) {
      const auto unclamped = testing::linear_push(measured, s, z);
      EXPECT_LT(testing::derivative(unclamped, 2, 1.0L) / t2 + 9.81L, -0.18L);
      const auto push = thesis_push(measured, s, z);
      ASSERT_TRUE(push);
      EXPECT_NEAR(push->force_m_s2(measured.duration_s), 0.0, 1e-7);
    }
    const auto heights = allowed_heights(measured, s);
    const auto expected = allowed_heights(free_fall, s);
    ASSERT_EQ(heights.has_value(), expected.has_value());
    if (!heights) continue;
    EXPECT_EQ(heights->low.height_m, expected->low.height_m);
    EXPECT_EQ(heights->high.height_m, expected->high.height_m);
  }
  EXPECT_FALSE(search_space(measured).empty());
}

TEST(ThesisPush, DeclinesWhatIsNotANumberAndTimesThatAreNone) {
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(),
                        std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity()};
  std::vector<PushEnds> wrong;
  for (const double value : bad) {
    for (const auto member : {&PushEnds::start_m,
                              &PushEnds::start_m_s,
                              &PushEnds::end_m,
                              &PushEnds::end_m_s,
                              &PushEnds::duration_s,
                              &PushEnds::gravity_m_s2}) {
      wrong.push_back(thesis_jump());
      wrong.back().*member = value;
    }
    // Minus infinity is below free fall.
    if (value < 0.0) continue;
    wrong.push_back(thesis_jump());
    wrong.back().start_m_s2 = value;
    wrong.push_back(thesis_jump());
    wrong.back().end_m_s2 = value;
  }
  for (const double t : {0.0, -0.7, 1e-200}) {
    wrong.push_back(thesis_jump());
    wrong.back().duration_s = t;
  }
  wrong.push_back(thesis_jump());
  wrong.back().gravity_m_s2 = 0.0;
  for (const PushEnds& ends : wrong) {
    EXPECT_FALSE(thesis_push(ends, 0.6, -0.25));
    EXPECT_FALSE(allowed_heights(ends, 0.6));
    EXPECT_TRUE(search_space(ends).empty());
    EXPECT_FALSE(choose_thesis_push(ends, near_point_cost(0.6, -0.25)));
  }
  EXPECT_FALSE(thesis_push(thesis_jump(), 0.6, bad[0]));
  EXPECT_FALSE(thesis_push(thesis_jump(), 1e-200, -0.25));
  EXPECT_FALSE(allowed_heights(thesis_jump(), 1e-200));
}

TEST(ThesisPush, EndsThatContradictTheRulesHaveNoPush) {
  const auto expect_none = [](const PushEnds& ends, const char* why) {
    EXPECT_TRUE(search_space(ends, 500).empty()) << why;
    EXPECT_FALSE(choose_thesis_push(ends, near_point_cost(0.6, 0.0))) << why;
  };
  PushEnds ends = thesis_jump();
  ends.start_m_s = 0.01;
  expect_none(ends, "the body rises at the start");
  ends = thesis_jump();
  ends.start_m_s2 = 0.01;
  expect_none(ends, "the body begins to rise at the start");
  ends = thesis_jump();
  ends.end_m_s = -0.01;
  expect_none(ends, "the body sinks at the end");
  ends = thesis_jump();
  ends.duration_s = 1e-6;
  expect_none(ends, "the rise takes more speed than the take-off has");
  ends = thesis_jump();
  ends.end_m_s = 14.0;
  expect_none(ends, "so much speed from rest in 0.7 s takes a force that turns negative");
}

/// Returns the least cost of a near-point cost over a fine grid of columns: within a
/// column the best height is the wanted one, or the end of the interval next to it.
double least_cost_of_grid(const PushEnds& ends, double at, double height_m) {
  const PushCost cost = near_point_cost(at, height_m);
  double least = std::numeric_limits<double>::infinity();
  for (const SpaceColumn& c : search_space(ends, 2000)) {
    const double z =
        std::clamp(height_m, c.heights.low.height_m, c.heights.high.height_m);
    least = std::min(least, cost(c.lowest_at, z));
  }
  return least;
}

TEST(ThesisPushChoice, IsTheWantedPointIfTheSpaceHasIt) {
  Dice dice(63);
  int found = 0;
  while (found < 100) {
    PushEnds ends = any_thesis_ends(dice);
    ends.start_m_s = -std::abs(ends.start_m_s);
    const double s = dice.between(0.3, 0.9);
    const auto heights = allowed_heights(ends, s);
    if (!heights) continue;
    const double z = dice.between(heights->low.height_m, heights->high.height_m);
    const auto push = choose_thesis_push(ends, near_point_cost(s, z));
    ASSERT_TRUE(push);
    EXPECT_NEAR(push->lowest_at, s, 1e-5);
    EXPECT_NEAR(push->height_m(s * ends.duration_s), z, 1e-5);
    ++found;
  }
}

TEST(ThesisPushChoice, IsTheBestOfAFineGrid) {
  Dice dice(64);
  int found = 0;
  while (found < 50) {
    PushEnds ends = any_thesis_ends(dice);
    ends.start_m_s = -std::abs(ends.start_m_s);
    const double at = dice.between(0.1, 0.9);
    const double height_m = ends.start_m + dice.between(-0.8, 0.2);
    const double least = least_cost_of_grid(ends, at, height_m);
    const auto push = choose_thesis_push(ends, near_point_cost(at, height_m));
    if (!push) {
      EXPECT_TRUE(std::isinf(least));
      continue;
    }
    const double z = push->height_m(push->lowest_at * ends.duration_s);
    const double cost = near_point_cost(at, height_m)(push->lowest_at, z);
    EXPECT_LE(cost, least + 1e-6) << at << ' ' << height_m;
    const auto heights = allowed_heights(ends, push->lowest_at);
    ASSERT_TRUE(heights);
    EXPECT_GE(z, heights->low.height_m - 1e-9);
    EXPECT_LE(z, heights->high.height_m + 1e-9);
    ++found;
  }
}

TEST(ThesisPushChoice, TakesAnyCost) {
  const PushEnds ends = thesis_jump();
  double lowest = 0.0;
  for (const SpaceColumn& c : search_space(ends, 2000))
    lowest = std::min(lowest, c.heights.low.height_m);
  const auto deepest = choose_thesis_push(ends, [](double, double z) { return z; });
  ASSERT_TRUE(deepest);
  EXPECT_LE(deepest->height_m(deepest->lowest_at * ends.duration_s), lowest + 1e-6);

  // An infinite cost excludes a part of the space; NaN excludes it, too.
  for (const double no : {std::numeric_limits<double>::infinity(),
                          std::numeric_limits<double>::quiet_NaN()}) {
    const auto late =
        choose_thesis_push(ends, [&](double at, double) { return at < 0.7 ? no : at; });
    ASSERT_TRUE(late);
    EXPECT_NEAR(late->lowest_at, 0.7, 1e-5);
    EXPECT_FALSE(choose_thesis_push(ends, [&](double, double) { return no; }));
  }
}

// The space shrinks to a point as the take-off speed grows. Just before, no column of the
// scan meets it.
TEST(ThesisPushChoice, FindsASpaceThatIsNarrowerThanAColumn) {
  PushEnds ends = thesis_jump();
  int narrow = 0;
  for (ends.end_m_s = 10.0; ends.end_m_s < 12.0; ends.end_m_s += 0.02) {
    if (!search_space(ends, 96).empty() || search_space(ends, 2000).empty()) continue;
    ++narrow;
    EXPECT_TRUE(choose_thesis_push(ends, near_point_cost(0.6, -0.2))) << ends.end_m_s;
  }
  EXPECT_GT(narrow, 0);
}

TEST(ThesisPush, AllocatesNothing) {
  const PushEnds ends = thesis_jump();
  const PushCost cost = near_point_cost(0.6, -0.25);
  const long before = testing::allocations();
  const auto push = thesis_push(ends, 0.6, -0.25);
  const auto heights = allowed_heights(ends, 0.6);
  const auto chosen = choose_thesis_push(ends, cost);
  EXPECT_EQ(testing::allocations(), before);
  EXPECT_TRUE(push && heights && chosen);
}

/// Take-off speed as section 6.2.1 of the thesis computes it for an apex: with the time
/// to the apex of the captured jump.
double take_off_speed_of_the_thesis(double captured_m_s, double rise_m) {
  const double to_apex_s = captured_m_s / 9.81;
  return (rise_m + 0.5 * 9.81 * to_apex_s * to_apex_s) / to_apex_s;
}

TEST(ThesisErratum, TheSpeedForAnApexReachesAnother) {
  const double captured_m_s = 2.43;
  const double rise_m = captured_m_s * captured_m_s / (2.0 * 9.81);
  const std::pair<double, double> wanted_and_reached[] = {
      {0.25, 0.390625}, {0.5, 0.5625}, {1.0, 1.0}, {2.0, 2.25}, {3.0, 4.0}};
  for (const auto& [wanted, reached] : wanted_and_reached) {
    const double speed = take_off_speed_of_the_thesis(captured_m_s, wanted * rise_m);
    EXPECT_NEAR(speed * speed / (2.0 * 9.81), reached * rise_m, 1e-12);
    EXPECT_NEAR(reached, 0.25 * (1.0 + wanted) * (1.0 + wanted), 1e-12);
    // The speed that reaches it.
    const double right = std::sqrt(2.0 * 9.81 * wanted * rise_m);
    EXPECT_GE(speed, right - 1e-12);
  }
}

}  // namespace
}  // namespace marey::dynamics
