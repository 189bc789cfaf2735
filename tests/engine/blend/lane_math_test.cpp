// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/blend/lane_math.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace marey::engine {
namespace {

double exact(float x) {
  return static_cast<double>(x);
}

TEST(LaneMath, SquaredAnglesHaveTheStatedErrors) {
  for (int i = 1; i <= 3000; ++i) {
    const auto u = static_cast<float>(i) * 5e-4F;
    const double angle_rad = std::acos(1.0 - exact(u));
    const double truth = angle_rad * angle_rad;
    EXPECT_NEAR(exact(wide_squared_angle(u)) / truth, 1.0, 6e-7) << u;
    if (u <= 1.0F) {
      EXPECT_NEAR(exact(squared_angle(u)) / truth, 1.0, 3e-7) << u;
    }
  }
}

TEST(LaneMath, SineAndCosineHaveTheStatedErrors) {
  for (int i = 1; i <= 4500; ++i) {
    const auto z = static_cast<float>(i) * 1e-3F;
    const double root = std::sqrt(exact(z));
    EXPECT_NEAR(exact(sine_over_angle(z)), std::sin(root) / root, 2e-7) << z;
    EXPECT_NEAR(exact(cosine_of_root(z)), std::cos(root), 2e-7) << z;
  }
  EXPECT_EQ(sine_over_angle(0.0F), 1.0F);
  EXPECT_EQ(cosine_of_root(0.0F), 1.0F);
}

TEST(LaneMath, InverseRootHasTheStatedErrorOverAllMagnitudes) {
  for (float x = 1e-30F; x < 1e30F; x *= 1.037F) {
    EXPECT_NEAR(exact(inverse_root(x)) * std::sqrt(exact(x)), 1.0, 3e-7) << x;
  }
}

TEST(LaneMath, WrapsToWithinHalfATurn) {
  for (int i = -4000; i <= 4000; ++i) {
    const float angle_rad = 0.01F * static_cast<float>(i);
    const float wrapped = wrapped_rad(angle_rad);
    EXPECT_LE(std::abs(exact(wrapped)), std::numbers::pi + 5e-6);
    EXPECT_NEAR(std::sin(exact(wrapped)), std::sin(exact(angle_rad)), 5e-6);
    EXPECT_NEAR(std::cos(exact(wrapped)), std::cos(exact(angle_rad)), 5e-6);
  }
  EXPECT_EQ(wrapped_rad(1.5F), 1.5F);
  EXPECT_EQ(wrapped_rad(0.0F), 0.0F);
}

TEST(LaneMath, SlerpWeightsHoldUpToTwoThirdsOfATurn) {
  for (int degree = 0; degree <= 120; ++degree) {
    const double angle_rad = degree * std::numbers::pi / 180.0;
    for (int i = 0; i <= 20; ++i) {
      const double at = 0.05 * i;
      const SlerpWeights weights = slerp_weights(
          static_cast<float>(angle_rad * angle_rad), static_cast<float>(at));
      const double first =
          degree == 0 ? 1.0 - at : std::sin((1.0 - at) * angle_rad) / std::sin(angle_rad);
      const double second =
          degree == 0 ? at : std::sin(at * angle_rad) / std::sin(angle_rad);
      EXPECT_NEAR(exact(weights.first), first, 1e-6);
      EXPECT_NEAR(exact(weights.second), second, 1e-6);
    }
  }
}

}  // namespace
}  // namespace marey::engine
