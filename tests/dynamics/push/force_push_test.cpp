// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/push/force_push.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/dynamics/push/made_push.h"
#include "tests/support/program/count_allocations.h"

namespace marey::dynamics {
namespace {

/// Integrates the push's own force with Simpson's rule on a fine grid. Returns velocity
/// and height at the end.
PushMoments integrate_by_simpson(const ForcePush& push) {
  constexpr int kSteps = 200000;
  const double t = push.duration_s();
  PushMoments out;
  for (int i = 0; i <= kSteps; ++i) {
    const double at_s = t * i / kSteps;
    const double weight = (i == 0 || i == kSteps ? 1.0
                           : i % 2 == 1          ? 4.0
                                                 : 2.0) *
                          t / (3.0 * kSteps);
    const double force = push.force_m_s2(at_s);
    out.impulse_m_s += weight * force;
    out.first_moment_m += weight * (t - at_s) * force;
  }
  return out;
}

double worst_force_on_grid(const ForcePush& push) {
  double worst = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 20000; ++i) {
    worst = std::min(worst, push.force_m_s2(push.duration_s() * i / 20000));
  }
  return worst;
}

TEST(ForcePush, IsTheReferenceItselfWhereTheEndsAreItsOwn) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const MadePush made = made_push(seed);
    const auto push = derive_push(made.reference, made.ends);
    ASSERT_TRUE(push) << seed;
    EXPECT_EQ(push->largest_correction_m_s2(), 0.0) << seed;
  }
}

TEST(ForcePush, MeetsBothEndStatesToRounding) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    const MadePush made = made_push(seed);
    const PushEnds ends = changed_ends(made, seed);
    const auto push = derive_push(made.reference, ends);
    if (!push) continue;
    const double t = ends.duration_s;
    EXPECT_EQ(push->height_m(0.0), ends.start_m);
    EXPECT_EQ(push->velocity_m_s(0.0), ends.start_m_s);
    EXPECT_NEAR(push->height_m(t), ends.end_m, 1e-12) << seed;
    EXPECT_NEAR(push->velocity_m_s(t), ends.end_m_s, 1e-12) << seed;
  }
}

TEST(ForcePush, ForceAndItsHeightAgreeWithNumericalIntegration) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const MadePush made = made_push(seed);
    const PushEnds ends = changed_ends(made, seed);
    const auto push = derive_push(made.reference, ends);
    if (!push) continue;
    const PushMoments truth = push_moments(ends);
    const PushMoments found = integrate_by_simpson(*push);
    EXPECT_NEAR(found.impulse_m_s, truth.impulse_m_s, 1e-7) << seed;
    EXPECT_NEAR(found.first_moment_m, truth.first_moment_m, 1e-7) << seed;
  }
}

TEST(ForcePush, VelocityAndForceAreTheDerivativesOfTheHeight) {
  const MadePush made = made_push(3);
  const auto push = derive_push(made.reference, changed_ends(made, 3));
  ASSERT_TRUE(push);
  constexpr double kStep_s = 1e-5;
  for (int i = 1; i < 400; ++i) {
    const double t_s = push->duration_s() * i / 400.3;
    const double slope =
        (push->height_m(t_s + kStep_s) - push->height_m(t_s - kStep_s)) / (2.0 * kStep_s);
    EXPECT_NEAR(slope, push->velocity_m_s(t_s), 1e-6);
    const double bend =
        (push->velocity_m_s(t_s + kStep_s) - push->velocity_m_s(t_s - kStep_s)) /
        (2.0 * kStep_s);
    EXPECT_NEAR(bend + kStandardGravity_m_s2, push->force_m_s2(t_s), 0.05);
  }
}

TEST(ForcePush, NeverPullsBetweenTheSamplesEither) {
  int derived = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    const MadePush made = made_push(seed);
    const auto push = derive_push(made.reference, changed_ends(made, seed));
    if (!push) continue;
    ++derived;
    EXPECT_GE(worst_force_on_grid(*push), -1e-6 * kStandardGravity_m_s2) << seed;
  }
  EXPECT_GT(derived, 350);
}

TEST(ForcePush, ExtremesAgreeWithAFineGrid) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const MadePush made = made_push(seed);
    const auto push = derive_push(made.reference, changed_ends(made, seed));
    if (!push) continue;
    double max_m_s2 = 0.0;
    for (int i = 0; i <= 20000; ++i) {
      max_m_s2 = std::max(max_m_s2, push->force_m_s2(push->duration_s() * i / 20000));
    }
    const auto extremes = push->extremes();
    EXPECT_NEAR(extremes.min.force_m_s2, worst_force_on_grid(*push), 1e-3) << seed;
    EXPECT_NEAR(extremes.max.force_m_s2, max_m_s2, 1e-3) << seed;
    EXPECT_LE(extremes.min.force_m_s2, worst_force_on_grid(*push) + 1e-12) << seed;
    EXPECT_GE(extremes.max.force_m_s2, max_m_s2 - 1e-12) << seed;
  }
}

TEST(ForcePush, StaysBelowTheLargestForce) {
  int derived = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    const MadePush made = made_push(seed);
    const double limit_m_s2 = 0.85 * made.peak_m_s2;
    const auto push =
        derive_push(made.reference, made.ends, {.max_force_m_s2 = limit_m_s2});
    if (!push) continue;
    ++derived;
    for (int i = 0; i <= 5000; ++i) {
      const double force = push->force_m_s2(push->duration_s() * i / 5000);
      EXPECT_LE(force, limit_m_s2 + 1e-6 * kStandardGravity_m_s2) << seed;
      EXPECT_GE(force, -1e-6 * kStandardGravity_m_s2) << seed;
    }
  }
  EXPECT_GT(derived, 200);
}

TEST(ForcePush, StaysAboveTheDeepestHeight) {
  int derived = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const MadePush made = made_push(seed);
    const auto free = derive_push(made.reference, made.ends);
    ASSERT_TRUE(free);
    double lowest_m = 0.0;
    for (int i = 0; i <= 2000; ++i) {
      lowest_m = std::min(lowest_m, free->height_m(free->duration_s() * i / 2000));
    }
    const double deepest_m = lowest_m + 0.2 * (std::min(made.ends.end_m, 0.0) - lowest_m);
    const auto push = derive_push(made.reference, made.ends, {.deepest_m = deepest_m});
    if (!push) continue;
    ++derived;
    for (int i = 0; i <= 2000; ++i) {
      EXPECT_GE(push->height_m(push->duration_s() * i / 2000), deepest_m - 1e-6) << seed;
    }
  }
  EXPECT_GT(derived, 100);
}

TEST(ForcePush, FallsThenRisesOnRequest) {
  int derived = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const MadePush made = made_push(seed);
    const auto push = derive_push(made.reference, made.ends, {.fall_then_rise = true});
    if (!push) continue;
    ++derived;
    int turns = 0;
    double before_m_s = push->velocity_m_s(push->duration_s() / 63.0);
    EXPECT_LE(before_m_s, 1e-6);
    for (int k = 2; k < kForceInstants; ++k) {
      const double now_m_s = push->velocity_m_s(push->duration_s() * k / 63.0);
      if (before_m_s < -1e-6 && now_m_s > 1e-6) ++turns;
      EXPECT_FALSE(before_m_s > 1e-6 && now_m_s < -1e-6) << seed << " " << k;
      if (std::abs(now_m_s) > 1e-6) before_m_s = now_m_s;
    }
    EXPECT_LE(turns, 1) << seed;
  }
  EXPECT_GT(derived, 100);
}

TEST(ForcePush, TiedEndsKeepTheForceOfTheReference) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const MadePush made = made_push(seed);
    PushEnds ends = made.ends;
    ends.end_m_s *= 1.15;
    const auto push = derive_push(made.reference, ends);
    ASSERT_TRUE(push) << seed;
    const double t = ends.duration_s;
    EXPECT_NEAR(push->force_m_s2(0.0), made.reference.force_m_s2.front(), 1e-9) << seed;
    EXPECT_NEAR(push->force_m_s2(t), made.reference.force_m_s2.back(), 1e-9) << seed;
  }
}

TEST(ForcePush, GivenAccelerationsAreMet) {
  const MadePush made = made_push(1);
  PushEnds ends = made.ends;
  ends.start_m_s2 = 1.5;
  ends.end_m_s2 = -kStandardGravity_m_s2 + 2.0;
  const auto push = derive_push(made.reference, ends);
  ASSERT_TRUE(push);
  EXPECT_NEAR(push->force_m_s2(0.0), kStandardGravity_m_s2 + 1.5, 1e-9);
  EXPECT_NEAR(push->force_m_s2(ends.duration_s), 2.0, 1e-9);
}

TEST(ForcePush, ALandingWithAnImpactComesToRest) {
  constexpr double kOneDuration_s = 0.45;
  std::vector<double> force;
  for (int i = 0; i < 54; ++i) {
    const double x = i / 53.0;
    const double impact = 45.0 * std::exp(-std::pow((x - 0.08) / 0.04, 2.0));
    const double brake = 14.0 * x * std::exp(-3.0 * x);
    force.push_back(std::min(1.0, 20.0 * x) * (9.81 + brake) + impact * (x > 0.0));
  }
  force.front() = 0.0;
  const PushReference reference = make_push_reference(kOneDuration_s, force);
  const double start_m_s = -2.4;
  const PushEnds own{
      1.0,
      start_m_s,
      1.0 + start_m_s * kOneDuration_s + reference.double_impulse_m.back() -
          0.5 * kStandardGravity_m_s2 * kOneDuration_s * kOneDuration_s,
      start_m_s + reference.impulse_m_s.back() - kStandardGravity_m_s2 * kOneDuration_s,
      kOneDuration_s};
  for (const double faster : {0.6, 0.8, 1.0, 1.2, 1.5}) {
    PushEnds ends = own;
    ends.start_m_s = start_m_s * faster;
    ends.end_m = 0.75;
    ends.end_m_s = 0.0;
    ends.duration_s = kOneDuration_s * std::sqrt(std::max(1.0, faster));
    const auto push = derive_push(reference, ends);
    ASSERT_TRUE(push) << faster;
    EXPECT_NEAR(push->height_m(ends.duration_s), 0.75, 1e-12);
    EXPECT_NEAR(push->velocity_m_s(ends.duration_s), 0.0, 1e-12);
    EXPECT_NEAR(push->force_m_s2(0.0), 0.0, 1e-9) << faster;
    EXPECT_NEAR(push->force_m_s2(ends.duration_s), force.back(), 1e-9) << faster;
    EXPECT_GE(worst_force_on_grid(*push), -1e-6 * kStandardGravity_m_s2) << faster;
  }
}

TEST(ForcePush, DeclinesImpossibleEndsAndValuesThatAreNotFinite) {
  const MadePush made = made_push(0);
  PushEnds ends = made.ends;
  ends.end_m = ends.start_m - 0.5 * kStandardGravity_m_s2 * ends.duration_s - 100.0;
  EXPECT_FALSE(derive_push(made.reference, ends));
  ends.end_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(derive_push(made.reference, ends));
  EXPECT_FALSE(derive_push(made.reference, made.ends, {.max_force_m_s2 = 1.0}));
}

TEST(ForcePush, DerivingAllocatesNothing) {
  const MadePush made = made_push(5);
  const PushEnds ends = changed_ends(made, 5);
  ASSERT_TRUE(derive_push(made.reference, ends));  // The tables are made once.
  const long before = testing::allocations();
  const bool is_derived =
      derive_push(made.reference, ends, {.deepest_m = -0.5}).has_value();
  EXPECT_EQ(testing::allocations(), before);
  EXPECT_TRUE(is_derived);
}

TEST(ForcePush, AHorizontalForceStaysInsideItsBounds) {
  constexpr double kOneDuration_s = 0.3;
  std::vector<double> force;
  for (int i = 0; i < 31; ++i) force.push_back(-3.0 * std::sin(2.0 * M_PI * i / 30.0));
  const PushReference reference = make_push_reference(kOneDuration_s, force);
  std::array<double, kForceInstants> largest_m_s2{};
  for (std::size_t k = 0; k < largest_m_s2.size(); ++k) {
    largest_m_s2[k] = 9.0 * std::sin(M_PI * static_cast<double>(k) / 63.0);
  }
  PushEnds ends{0.0, 3.0, 0.9 + reference.double_impulse_m.back(), 3.0, kOneDuration_s};
  ends.end_m_s += reference.impulse_m_s.back();
  const auto same = derive_horizontal_push(reference, ends, largest_m_s2);
  ASSERT_TRUE(same);
  EXPECT_LT(same->largest_correction_m_s2(), 1e-9);
  ends.end_m_s += 1.1;
  ends.end_m += 0.2;
  const auto push = derive_horizontal_push(reference, ends, largest_m_s2);
  ASSERT_TRUE(push);
  EXPECT_NEAR(push->height_m(kOneDuration_s), ends.end_m, 1e-12);
  EXPECT_NEAR(push->velocity_m_s(kOneDuration_s), ends.end_m_s, 1e-12);
  for (std::size_t k = 0; k < largest_m_s2.size(); ++k) {
    const double x = static_cast<double>(k) / 63.0;
    const double own = std::abs(3.0 * std::sin(2.0 * M_PI * x));
    EXPECT_LE(std::abs(push->force_m_s2(x * kOneDuration_s)),
              std::max(largest_m_s2[k], own) + 1e-5);
  }
  ends.end_m_s += 10.0;
  EXPECT_FALSE(derive_horizontal_push(reference, ends, largest_m_s2));
}

}  // namespace
}  // namespace marey::dynamics
