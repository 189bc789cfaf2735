// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The search space of the thesis' law: its figures for the jump of figure 6.6, and its
// meaning, judged by the linear system and dense sampling.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "dynamics/push/thesis_push.h"
#include <gtest/gtest.h>

#include "tests/dynamics/push/linear_push.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::dynamics {
namespace {

using testing::Dice;
using testing::LinearPush;

constexpr PushRule kByForce = PushRule::kForce;
constexpr PushRule kByFall = PushRule::kFall;
constexpr PushRule kByRise = PushRule::kRise;

PushEnds table_case(double take_off_m_s = 2.43) {
  PushEnds ends;
  ends.end_m = 0.08;
  ends.end_m_s = take_off_m_s;
  ends.duration_s = 0.7;
  return ends;
}

PushEnds table_case_into_free_fall() {
  PushEnds ends = table_case();
  ends.end_m_s2 = -9.81;
  return ends;
}

/// Ends of pushes and landings from which a space is likely.
PushEnds likely_thesis_ends(Dice& dice) {
  PushEnds ends;
  ends.start_m = dice.between(0.5, 1.3);
  ends.start_m_s = dice.between(0.0, 1.0) < 0.3 ? 0.0 : dice.between(-2.5, 0.0);
  ends.end_m = ends.start_m + dice.between(-0.2, 0.2);
  ends.end_m_s = dice.between(0.0, 1.0) < 0.1 ? 0.0 : dice.between(0.2, 3.5);
  ends.duration_s = dice.between(0.2, 1.2);
  if (ends.start_m_s < 0.0 && dice.between(0.0, 1.0) < 0.7)
    ends.start_m_s2 = dice.between(0.0, 1.0) < 0.5 ? -9.81 : dice.between(-9.81, 20.0);
  if (ends.end_m_s > 0.0 && dice.between(0.0, 1.0) < 0.5)
    ends.end_m_s2 = dice.between(0.0, 1.0) < 0.5 ? -9.81 : dice.between(-9.81, 20.0);
  return ends;
}

struct BoundRow {
  double at;
  int top_mm;
  PushRule top_rule;
  int bottom_mm;
  PushRule bottom_rule;
  double bottom_at;
};

const BoundRow kBoundTable[] = {{0.44, -155, kByRise, -157, kByForce, 0.08},
                                {0.49, -155, kByRise, -180, kByForce, 0.08},
                                {0.54, -160, kByRise, -210, kByForce, 0.09},
                                {0.59, -163, kByRise, -328, kByForce, 0.12},
                                {0.64, -161, kByFall, -344, kByFall, 0.0},
                                {0.69, -153, kByFall, -225, kByFall, 0.0},
                                {0.74, -137, kByFall, -166, kByFall, 0.01}};
const BoundRow kBoundTableIntoFreeFall[] = {{0.61, -269, kByForce, -363, kByForce, 0.12},
                                            {0.65, -201, kByForce, -372, kByFall, 0.0},
                                            {0.69, -183, kByForce, -269, kByFall, 0.0},
                                            {0.73, -166, kByFall, -209, kByFall, 0.0},
                                            {0.77, -146, kByFall, -161, kByFall, 0.24}};

/// The table, rounded to 1 mm, was made by sampling 240 instants. An exact bound lies
/// inside: by up to 1.4 mm where it binds between instants or at an end.
void expect_row(const PushEnds& ends, const BoundRow& row) {
  SCOPED_TRACE(row.at);
  const auto sampled = testing::sampled_heights(ends, row.at, 240, false);
  EXPECT_NEAR(static_cast<double>(1e3L * sampled.high_m), row.top_mm, 0.55);
  EXPECT_NEAR(static_cast<double>(1e3L * sampled.low_m), row.bottom_mm, 0.55);
  const auto heights = allowed_heights(ends, row.at);
  ASSERT_TRUE(heights);
  EXPECT_EQ(heights->high.rule, row.top_rule);
  EXPECT_EQ(heights->low.rule, row.bottom_rule);
  EXPECT_NEAR(heights->low.at, row.bottom_at, 0.006);
  EXPECT_LE(heights->high.height_m, sampled.high_m + 1e-12L);
  EXPECT_GE(heights->low.height_m, sampled.low_m - 1e-12L);
  EXPECT_NEAR(
      1e3 * heights->high.height_m, static_cast<double>(1e3L * sampled.high_m), 1.4);
  EXPECT_NEAR(
      1e3 * heights->low.height_m, static_cast<double>(1e3L * sampled.low_m), 1.4);
  // And the limit of ever finer sampling is the exact bound.
  const auto fine = testing::sampled_heights(ends, row.at, 20'000, false);
  EXPECT_NEAR(heights->high.height_m, static_cast<double>(fine.high_m), 3e-5);
  EXPECT_NEAR(heights->low.height_m, static_cast<double>(fine.low_m), 3e-5);
}

TEST(ThesisSpace, HasTheBoundsOfTheTable) {
  for (const BoundRow& row : kBoundTable) expect_row(table_case(), row);
  for (const BoundRow& row : kBoundTableIntoFreeFall)
    expect_row(table_case_into_free_fall(), row);
}

struct SpaceSize {
  double area_mm = 0.0;
  double from = 1.0;
  double to = 0.0;
  double top_mm = -1e9;
};

SpaceSize size_of_space(const PushEnds& ends, int columns = 2000) {
  SpaceSize size;
  for (const SpaceColumn& c : search_space(ends, columns)) {
    const double top_mm = 1e3 * c.heights.high.height_m;
    size.area_mm += (top_mm - 1e3 * c.heights.low.height_m) / columns;
    size.from = std::min(size.from, c.lowest_at);
    size.to = std::max(size.to, c.lowest_at);
    size.top_mm = std::max(size.top_mm, top_mm);
  }
  return size;
}

/// The same by sampling instants, and by the force rule alone if wanted.
SpaceSize size_by_sampling(const PushEnds& ends, bool only_force) {
  constexpr int kColumns = 250;
  SpaceSize size;
  for (int k = 0; k < kColumns; ++k) {
    const double s = (k + 0.5) / kColumns;
    const auto h = testing::sampled_heights(ends, s, 240, only_force);
    if (h.low_m > h.high_m) continue;
    size.area_mm += static_cast<double>(h.high_m - h.low_m) * 1e3 / kColumns;
    size.from = std::min(size.from, s);
    size.to = std::max(size.to, s);
    size.top_mm = std::max(size.top_mm, static_cast<double>(1e3L * h.high_m));
  }
  return size;
}

TEST(ThesisSpace, HasTheAreasOfTheDesign) {
  const std::pair<PushEnds, double> cases[] = {{table_case(), 26.7},
                                               {table_case_into_free_fall(), 16.3},
                                               {table_case(0.5 * 2.43), 49.8},
                                               {table_case(1.4 * 2.43), 9.2}};
  for (const auto& [ends, area_mm] : cases) {
    const double sampled_mm = size_by_sampling(ends, false).area_mm;
    EXPECT_NEAR(sampled_mm, area_mm, 0.15);
    const double exact_mm = size_of_space(ends).area_mm;
    EXPECT_LT(exact_mm, sampled_mm);
    EXPECT_NEAR(exact_mm, area_mm, 0.3);
  }
  const SpaceSize size = size_of_space(table_case());
  EXPECT_NEAR(size.from, 0.44, 0.005);
  EXPECT_NEAR(size.to, 0.785, 0.005);
}

// Section 6.3.1 of the thesis names the force rule alone.
TEST(ThesisSpace, IsFourTimesLargerByTheForceRuleAlone) {
  const SpaceSize size = size_by_sampling(table_case(), true);
  EXPECT_NEAR(size.area_mm, 103.8, 0.2);
  EXPECT_NEAR(size.top_mm, 92.0, 0.5);
  EXPECT_LT(size.from, 0.04);
}

/// Share of midpoints of two members that are not members. Members are spread evenly over
/// the area, or with equal weights of the columns.
double share_outside(const PushEnds& ends, bool by_columns) {
  Dice dice(65);
  const auto is_member = [&](double s, double z) {
    const auto h = allowed_heights(ends, s);
    return h && z >= h->low.height_m && z <= h->high.height_m;
  };
  const auto member = [&] {
    for (;;) {
      const double s = dice.between(0.4, 0.8);
      const auto h = allowed_heights(ends, s);
      if (!h) continue;
      if (by_columns)
        return std::pair(s, dice.between(h->low.height_m, h->high.height_m));
      const double z = dice.between(-0.4, -0.1);
      if (z >= h->low.height_m && z <= h->high.height_m) return std::pair(s, z);
    }
  };
  constexpr int kPairs = 5000;
  int outside = 0;
  for (int k = 0; k < kPairs; ++k) {
    const auto [s1, z1] = member();
    const auto [s2, z2] = member();
    if (!is_member(0.5 * (s1 + s2), 0.5 * (z1 + z2))) ++outside;
  }
  return static_cast<double>(outside) / kPairs;
}

// Section 6.3.2 of the thesis concludes from convexity that a descent finds the minimum.
TEST(ThesisSpace, IsNotConvex) {
  EXPECT_NEAR(share_outside(table_case(), true), 0.19, 0.02);
  EXPECT_NEAR(share_outside(table_case(), false), 0.066, 0.015);
}

TEST(ThesisSpace, GrowsAsTheTakeOffSpeedFalls) {
  double before_mm = 0.0;
  for (double speed = 3.6; speed > 1.0; speed -= 0.1) {
    const double area_mm = size_of_space(table_case(speed), 500).area_mm;
    EXPECT_GT(area_mm, before_mm) << speed;
    before_mm = area_mm;
  }
}

/// Instants inside (0, 1): equally spaced, and ever closer to both ends.
std::vector<long double> dense_instants() {
  std::vector<long double> instants;
  for (int i = 1; i < 1000; ++i) instants.push_back(i / 1000.0L);
  for (long double x = 1e-3L; x > 1e-7L; x *= 0.7L) {
    instants.push_back(x);
    instants.push_back(1.0L - x);
  }
  return instants;
}

/// The worst violations by dense sampling: negative where a rule is broken.
struct RuleViolations {
  long double force_m_s2 = 0.0;
  long double velocity_m_s = 0.0;  ///< Downwards after s, upwards before.
};

RuleViolations violations_of(const PushEnds& ends, double s, double z) {
  static const std::vector<long double> kInstants = dense_instants();
  const LinearPush push = testing::linear_push(ends, s, z);
  const long double t = ends.duration_s;
  RuleViolations worst;
  for (const long double x : kInstants) {
    const long double force = testing::derivative(push, 2, x) / (t * t);
    worst.force_m_s2 = std::min(worst.force_m_s2, force + ends.gravity_m_s2);
    const long double speed = testing::derivative(push, 1, x) / t;
    worst.velocity_m_s = std::min(worst.velocity_m_s, x < s ? -speed : speed);
  }
  return worst;
}

TEST(ThesisSpace, MembersPushAndFallThenRiseAndOthersDoNot) {
  Dice dice(66);
  int spaces = 0;
  while (spaces < 300) {
    const PushEnds ends = likely_thesis_ends(dice);
    const double s = dice.between(0.05, 0.95);
    const auto heights = allowed_heights(ends, s);
    if (!heights) continue;
    ++spaces;
    SCOPED_TRACE(spaces);
    const double low = heights->low.height_m;
    const double high = heights->high.height_m;
    for (const double share : {0.0, dice.between(0.0, 1.0), 1.0}) {
      const RuleViolations v = violations_of(ends, s, low + share * (high - low));
      EXPECT_GT(v.force_m_s2, -1e-6L);
      EXPECT_GT(v.velocity_m_s, -1e-8L);
    }
    for (const double z : {low - 1e-4, high + 1e-4}) {
      const RuleViolations v = violations_of(ends, s, z);
      EXPECT_TRUE(v.force_m_s2 < -1e-15L || v.velocity_m_s < -1e-15L) << z;
    }
  }
}

// An empty interval is empty by dense sampling, too.
TEST(ThesisSpace, ColumnsWithoutHeightsHaveNoMember) {
  Dice dice(67);
  for (int empty = 0; empty < 200;) {
    const PushEnds ends = likely_thesis_ends(dice);
    const double s = dice.between(0.05, 0.95);
    if (allowed_heights(ends, s)) continue;
    ++empty;
    const auto fine = testing::sampled_heights(ends, s, 5000, false);
    EXPECT_LT(fine.high_m, fine.low_m + 1e-4L);
  }
}

TEST(ThesisSpace, ALowestPointOnTheBoundaryTouchesItsRule) {
  Dice dice(68);
  int checked = 0;
  while (checked < 500) {
    const PushEnds ends = likely_thesis_ends(dice);
    const double s = dice.between(0.1, 0.9);
    const auto heights = allowed_heights(ends, s);
    if (!heights) continue;
    for (const HeightBound& bound : {heights->low, heights->high}) {
      ++checked;
      const LinearPush push = testing::linear_push(ends, s, bound.height_m);
      const long double t = ends.duration_s;
      const int order = bound.rule == kByForce ? 2 : 1;
      const long double free = bound.rule == kByForce ? ends.gravity_m_s2 * t * t : 0.0L;
      const long double touch = testing::derivative(push, order, bound.at) + free;
      EXPECT_NEAR(static_cast<double>(touch), 0.0, 1e-8);
      if (bound.rule != kByForce) {
        EXPECT_EQ(bound.rule == kByFall, bound.at < s);
      }

      // It only touches: the rule holds on both sides.
      for (const long double x : {bound.at - 1e-3L, bound.at + 1e-3L}) {
        if (x <= 0.0L || x >= 1.0L) continue;
        const long double sign = bound.rule == kByForce || x > s ? 1.0L : -1.0L;
        EXPECT_GT(sign * (testing::derivative(push, order, x) + free), -1e-8L);
      }
    }
  }
}

// Lengths times k and times by the root of k are the same motion under the same gravity.
TEST(ThesisSpace, ScalesWithHeightsAndGravity) {
  Dice dice(69);
  for (int checked = 0; checked < 200;) {
    const PushEnds ends = likely_thesis_ends(dice);
    const double s = dice.between(0.1, 0.9);
    const auto heights = allowed_heights(ends, s);
    if (!heights) continue;
    ++checked;
    const double k = dice.between(0.2, 5.0);
    PushEnds large = ends;
    large.start_m *= k;
    large.end_m *= k;
    large.start_m_s *= std::sqrt(k);
    large.end_m_s *= std::sqrt(k);
    large.duration_s *= std::sqrt(k);
    const auto scaled = allowed_heights(large, s);
    ASSERT_TRUE(scaled);
    EXPECT_NEAR(scaled->low.height_m, k * heights->low.height_m, 1e-9);
    EXPECT_NEAR(scaled->high.height_m, k * heights->high.height_m, 1e-9);

    // Another gravity in another time; and another origin of heights.
    PushEnds moon = ends;
    moon.gravity_m_s2 *= k;
    if (moon.start_m_s2) *moon.start_m_s2 *= k;
    if (moon.end_m_s2) *moon.end_m_s2 *= k;
    moon.start_m_s *= std::sqrt(k);
    moon.end_m_s *= std::sqrt(k);
    moon.duration_s /= std::sqrt(k);
    moon.start_m += 10.0;
    moon.end_m += 10.0;
    const auto moved = allowed_heights(moon, s);
    ASSERT_TRUE(moved);
    EXPECT_NEAR(moved->low.height_m, 10.0 + heights->low.height_m, 1e-9);
    EXPECT_NEAR(moved->high.height_m, 10.0 + heights->high.height_m, 1e-9);
  }
}

}  // namespace
}  // namespace marey::dynamics
