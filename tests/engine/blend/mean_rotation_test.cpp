// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/blend/mean_rotation.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/blend/blend_truth.h"

namespace marey::engine {
namespace {

constexpr double kRadPerDegree = std::numbers::pi / 180.0;

std::vector<double> random_weights(std::mt19937& random, std::size_t count) {
  std::vector<double> weights(count);
  for (double& weight : weights) weight = random_in(random, 0.01, 1.0);
  return weights;
}

double worst_degrees(double spread_degrees, unsigned first_seed) {
  double worst_rad = 0.0;
  for (unsigned seed = first_seed; seed < first_seed + 4000; ++seed) {
    std::mt19937 random(seed);
    const std::size_t count = 3 + seed % 2;
    const auto rotations = random_spread(random, count, spread_degrees * kRadPerDegree);
    const auto weights = random_weights(random, count);
    worst_rad = std::max(worst_rad,
                         angle_between_rad(mean_rotation(rotations, weights),
                                           karcher_mean(rotations, weights)));
  }
  return worst_rad / kRadPerDegree;
}

TEST(MeanRotation, IsWithinAHundredthOfADegreeOfTheIntrinsicMean) {
  EXPECT_LT(worst_degrees(60.0, 1), 1e-4);
  EXPECT_LT(worst_degrees(120.0, 100001), 0.01);
}

TEST(MeanRotation, IsTheSlerpForTwo) {
  for (unsigned seed = 0; seed < 2000; ++seed) {
    std::mt19937 random(seed);
    const auto rotations = random_spread(random, 2, 175.0 * kRadPerDegree);
    const double at = random_in(random, 0.0, 1.0);
    const std::array<double, 2> weights{3.0 * (1.0 - at), 3.0 * at};
    const glm::dquat slerp =
        rotations[0] * exp_of(at * log_of(glm::conjugate(rotations[0]) * rotations[1]));
    EXPECT_LT(angle_between_rad(mean_rotation(rotations, weights), slerp), 1e-12);
  }
}

TEST(MeanRotation, DoesNotDependOnTheOrderBeyondRounding) {
  for (unsigned seed = 0; seed < 500; ++seed) {
    std::mt19937 random(seed);
    auto rotations = random_spread(random, 4, 120.0 * kRadPerDegree);
    auto weights = random_weights(random, 4);
    const glm::dquat mean = mean_rotation(rotations, weights);
    EXPECT_EQ(mean, mean_rotation(rotations, weights));
    std::reverse(rotations.begin(), rotations.end());
    std::reverse(weights.begin(), weights.end());
    EXPECT_LT(angle_between_rad(mean, mean_rotation(rotations, weights)), 1e-13);
  }
}

TEST(MeanRotation, LeavesARotationOfWholeWeightToTheBit) {
  std::mt19937 random(7);
  const auto rotations = random_spread(random, 3, 2.0);
  EXPECT_EQ(mean_rotation(rotations, std::array<double, 3>{0.0, 0.3, 0.0}), rotations[1]);
}

TEST(MeanRotation, TakesTheArcOnTheGivenSide) {
  // 200 degrees apart about Y by way of +100, 160 by way of -80.
  const glm::dquat a{1.0, 0.0, 0.0, 0.0};
  const glm::dquat b = exp_of({0.0, 200.0 * kRadPerDegree, 0.0});
  const std::array<glm::dquat, 2> both{a, b};
  const std::array<double, 2> weights{0.5, 0.5};
  const glm::dquat forward = exp_of({0.0, 100.0 * kRadPerDegree, 0.0});
  const glm::dquat backward = exp_of({0.0, -80.0 * kRadPerDegree, 0.0});
  EXPECT_LT(angle_between_rad(mean_rotation(both, weights), backward), 1e-12);
  EXPECT_LT(angle_between_rad(mean_rotation(both, weights, &forward), forward), 1e-12);
}

TEST(MeanRotation, IsAUnitQuaternionForOppositeRotations) {
  const std::array<glm::dquat, 3> rotations{glm::dquat(1.0, 0.0, 0.0, 0.0),
                                            glm::dquat(0.0, 1.0, 0.0, 0.0),
                                            glm::dquat(0.0, 0.0, 1.0, 0.0)};
  const auto mean = mean_rotation(rotations, std::array<double, 3>{1.0, 1.0, 1.0});
  EXPECT_NEAR(glm::length(mean), 1.0, 1e-14);
}

}  // namespace
}  // namespace marey::engine
