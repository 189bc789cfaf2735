// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/signal/cubic_spline.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/bodies/random_bodies.h"

namespace marey {
namespace {

using marey::testing::Dice;

struct SplineKnots {
  std::vector<double> x;
  std::vector<double> y;
};

SplineKnots random_knots(Dice& dice) {
  SplineKnots out;
  double x = dice.between(-1.0, 1.0);
  for (int i = 0; i < 12; ++i) {
    out.x.push_back(x);
    out.y.push_back(dice.between(-1.0, 1.0));
    x += dice.between(0.2, 1.5);
  }
  return out;
}

TEST(CubicSpline, GoesThroughItsKnotsWithContinuousBend) {
  Dice dice(1);
  for (int round = 0; round < 20; ++round) {
    const SplineKnots knots = random_knots(dice);
    const CubicSpline spline(knots.x, knots.y);
    constexpr double kStep = 1e-4;
    for (std::size_t i = 0; i < knots.x.size(); ++i) {
      EXPECT_NEAR(spline.at(knots.x[i]), knots.y[i], 1e-12);
      if (i == 0 || i + 1 == knots.x.size()) continue;
      const double x = knots.x[i];
      const double before = (spline.slope_at(x) - spline.slope_at(x - kStep)) / kStep;
      const double after = (spline.slope_at(x + kStep) - spline.slope_at(x)) / kStep;
      EXPECT_NEAR(before, after, 0.02);
    }
  }
}

TEST(CubicSpline, ReproducesALineAndContinuesIt) {
  const std::vector<double> x{0.0, 1.0, 3.0, 3.5};
  const std::vector<double> y{1.0, 3.0, 7.0, 8.0};
  const CubicSpline spline(x, y);
  for (const double at : {-2.0, 0.3, 2.2, 3.4, 9.0}) {
    EXPECT_NEAR(spline.at(at), 1.0 + 2.0 * at, 1e-12);
    EXPECT_NEAR(spline.slope_at(at), 2.0, 1e-12);
  }
}

TEST(CubicSpline, StartsWithTheGivenSlope) {
  Dice dice(2);
  const SplineKnots knots = random_knots(dice);
  const CubicSpline spline(knots.x, knots.y, 0.7);
  EXPECT_NEAR(spline.slope_at(knots.x.front()), 0.7, 1e-12);
  EXPECT_NEAR(spline.at(knots.x[5]), knots.y[5], 1e-12);
}

}  // namespace
}  // namespace marey
