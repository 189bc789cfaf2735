// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/signal/rotation_channels.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "edit/signal/butterworth.h"
#include <gtest/gtest.h>

#include "core/signal/choose_smoothing.h"
#include "core/transform.h"

namespace marey::edit {
namespace {

constexpr double kSwingRate_hz = 120.0;
using Rotations = std::vector<glm::dquat>;

/// Largest entry of the difference of the rotations, either sign.
double largest_difference(const Rotations& a, const Rotations& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double sign = glm::dot(a[i], b[i]) < 0.0 ? -1.0 : 1.0;
    const glm::dquat d = a[i] + b[i] * -sign;
    for (const double entry : {d.w, d.x, d.y, d.z}) {
      largest = std::max(largest, std::abs(entry));
    }
  }
  return largest;
}

double rms_angle(const Rotations& a, const Rotations& b) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const glm::dvec3 angle = rotation_vector(glm::conjugate(a[i]) * b[i]);
    squares += glm::dot(angle, angle) / 3.0;
  }
  return std::sqrt(squares / static_cast<double>(a.size()));
}

/// A joint that swings by up to `size_rad` about three axes, at up to 2.3 Hz.
Rotations swinging(std::size_t samples, double size_rad) {
  Rotations rotations;
  for (std::size_t i = 0; i < samples; ++i) {
    const double t = 2.0 * std::numbers::pi * static_cast<double>(i) / kSwingRate_hz;
    rotations.push_back(
        rotation_from_vector({size_rad * std::sin(0.9 * t), 0.0, 0.0}) *
        rotation_from_vector({0.0, 0.7 * size_rad * std::sin(1.4 * t + 1.0), 0.0}) *
        rotation_from_vector({0.0, 0.0, 0.4 * size_rad * std::cos(2.3 * t)}));
  }
  return rotations;
}

Rotations spinning(std::size_t samples, double turns, const glm::dvec3& axis) {
  Rotations rotations;
  for (std::size_t i = 0; i < samples; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(samples - 1);
    const double half_angle = std::numbers::pi * turns * share;
    const glm::dvec3 part = std::sin(half_angle) * glm::normalize(axis);
    rotations.emplace_back(std::cos(half_angle), part.x, part.y, part.z);
  }
  return rotations;
}

Rotations rotations_with_noise(Rotations rotations, double sigma_rad, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, sigma_rad);
  for (glm::dquat& rotation : rotations) {
    const double x = noise(random);
    const double y = noise(random);
    const double z = noise(random);
    rotation = rotation * rotation_from_vector({x, y, z});
  }
  return rotations;
}

VectorFilter spline_filter(double cutoff_hz, int order) {
  return [=](std::span<std::vector<double>> channels) {
    SmoothingSpline spline(channels[0].size(), {order});
    spline.set_penalty(penalty_of_half_power(cutoff_hz, kSwingRate_hz, {order}));
    for (auto& channel : channels) static_cast<void>(spline.fit(channel, channel));
  };
}

/// A filter whose penalty is chosen once, so that both runs share it.
VectorFilter gcv_filter(const Rotations& rotations) {
  const RotationChannels built(rotations);
  auto channels = built.channels();
  const std::vector<std::vector<std::size_t>> groups{{0, 1, 2}};
  const auto report = smooth_groups(channels, groups, kSwingRate_hz);
  return spline_filter(report.groups[0].cutoff_hz, 2);
}

VectorFilter butterworth_filter(double cutoff_hz) {
  return [=](std::span<std::vector<double>> channels) {
    for (auto& channel : channels) filter_butterworth(channel, cutoff_hz, kSwingRate_hz);
  };
}

std::vector<VectorFilter> all_filters() {
  return {spline_filter(6.0, 2), spline_filter(6.0, 3), butterworth_filter(6.0)};
}

const glm::dquat kWorld = rotation_from_vector({0.4, -1.9, 0.8});
const glm::dquat kJoint = rotation_from_vector({-1.1, 0.3, 2.0});

TEST(RotationChannels, OtherWorldAxesTurnTheResultAndNothingElse) {
  const Rotations source = rotations_with_noise(swinging(480, 1.2), 0.02, 1);
  Rotations turned;
  for (const auto& q : source) turned.push_back(kWorld * q);
  for (const VectorFilter& filter : all_filters()) {
    Rotations expected = filter_rotations(source, filter);
    for (auto& q : expected) q = kWorld * q;
    EXPECT_LT(largest_difference(filter_rotations(turned, filter), expected), 1e-9);
  }
}

TEST(RotationChannels, OtherJointAxesTurnTheResultAndNothingElse) {
  const Rotations source = rotations_with_noise(swinging(480, 1.2), 0.02, 2);
  Rotations turned;
  for (const auto& q : source) turned.push_back(q * kJoint);
  for (const VectorFilter& filter : all_filters()) {
    Rotations expected = filter_rotations(source, filter);
    for (auto& q : expected) q = q * kJoint;
    EXPECT_LT(largest_difference(filter_rotations(turned, filter), expected), 1e-9);
  }
}

TEST(RotationChannels, SignsOfQuaternionsDoNotMatter) {
  const Rotations source = rotations_with_noise(swinging(480, 1.2), 0.02, 3);
  Rotations flipped = source;
  for (std::size_t i = 0; i < flipped.size(); i += 3) flipped[i] = -flipped[i];
  const VectorFilter filter = spline_filter(6.0, 2);
  EXPECT_LT(largest_difference(filter_rotations(flipped, filter),
                               filter_rotations(source, filter)),
            1e-12);
}

TEST(RotationChannels, ChannelsThatAreNotFilteredGiveTheRotationsBack) {
  const Rotations source = rotations_with_noise(swinging(480, 1.2), 0.05, 4);
  const auto nothing = [](std::span<std::vector<double>>) {};
  EXPECT_LT(largest_difference(filter_rotations(source, nothing), source), 1e-13);
}

TEST(RotationChannels, AConstantRotationIsReproduced) {
  const Rotations constant(200, kJoint);
  for (const VectorFilter& filter : all_filters()) {
    EXPECT_LT(largest_difference(filter_rotations(constant, filter), constant), 1e-12);
  }
}

TEST(RotationChannels, AConstantAngularSpeedIsReproducedOverFiveTurns) {
  Rotations spin = spinning(480, 5.0, {0.2, 1.0, -0.4});
  for (auto& q : spin) q = kWorld * q * kJoint;
  for (const int order : {2, 3}) {
    const auto result = filter_rotations(spin, spline_filter(6.0, order));
    EXPECT_LT(largest_difference(result, spin), 1e-10);
  }
}

TEST(RotationChannels, ASpinOfFiveTurnsWithNoiseHasNoSeam) {
  const Rotations truth = spinning(600, 5.0, {0.2, 1.0, -0.4});
  const Rotations result =
      filter_rotations(rotations_with_noise(truth, 0.02, 5), spline_filter(6.0, 2));
  const double step_rad = 10.0 * std::numbers::pi / 599.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto off = rotation_vector(glm::conjugate(truth[i]) * result[i]);
    EXPECT_LT(glm::length(off), 0.05) << i;
    if (i == 0) continue;
    EXPECT_GT(glm::dot(result[i - 1], result[i]), 0.0);
    const auto step = rotation_vector(glm::conjugate(result[i - 1]) * result[i]);
    EXPECT_NEAR(glm::length(step), step_rad, 0.02) << i;
  }
  EXPECT_LT(rms_angle(result, truth), 0.5 * 0.02);
}

TEST(RotationChannels, NoiseIsReducedAsMuchAsThatOfAVector) {
  // Against white noise on a vector, for small and large movements.
  for (const double size_rad : {0.05, 0.5, 1.5}) {
    const Rotations truth = swinging(1200, size_rad);
    const VectorFilter filter = spline_filter(8.0, 2);
    const auto without_noise = filter_rotations(truth, filter);
    double errors = 0.0;
    for (unsigned seed = 0; seed < 5; ++seed) {
      const Rotations noisy = rotations_with_noise(truth, 0.01, seed);
      errors += rms_angle(filter_rotations(noisy, filter), without_noise) / 5.0;
    }
    // Sigma of white noise after the filter: the root of the mean of 1 / (1 + x^4)^2.
    const double expected = 0.01 * std::sqrt(2.0 * 8.0 / kSwingRate_hz * 1.038);
    EXPECT_NEAR(errors / expected, 1.0, 0.06) << size_rad;
  }
}

TEST(RotationChannels, TheChosenPenaltyReducesNoiseByHalfOrMore) {
  const Rotations truth = swinging(600, 1.0);
  for (const double sigma_rad : {0.01, 0.05}) {
    const Rotations noisy = rotations_with_noise(truth, sigma_rad, 6);
    const auto result = filter_rotations(noisy, gcv_filter(noisy));
    EXPECT_LT(rms_angle(result, truth), 0.45 * sigma_rad);
  }
}

TEST(RotationChannels, RotationsAboutOneAxisAreThoseOfTheirFilteredAngle) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.03);
  const glm::dvec3 axis = glm::normalize(glm::dvec3{0.3, -0.5, 0.8});
  std::vector<double> angle;
  Rotations rotations;
  for (int i = 0; i < 600; ++i) {
    angle.push_back(4.0 * std::sin(0.03 * i) + noise(random));
    rotations.push_back(glm::angleAxis(angle.back(), axis));
  }
  const VectorFilter filter = spline_filter(6.0, 2);
  const auto result = filter_rotations(rotations, filter);
  filter(std::span(&angle, 1));
  Rotations expected;
  for (const double value : angle) expected.push_back(glm::angleAxis(value, axis));
  EXPECT_LT(largest_difference(result, expected), 1e-10);
}

TEST(RotationChannels, ASwingThatIsFilteredAwayLeavesContinuousRotations) {
  // 2 rad at 1 Hz, removed by a cut-off of 0.2 Hz.
  const Rotations source = swinging(1200, 2.0);
  const auto result = filter_rotations(source, spline_filter(0.2, 2));
  for (std::size_t i = 1; i < result.size(); ++i) {
    const auto step = rotation_vector(glm::conjugate(result[i - 1]) * result[i]);
    EXPECT_LT(glm::length(step), 0.15) << i;
  }
}

TEST(RotationChannels, EmptyAndSingleSequencesAreReturned) {
  const auto nothing = [](std::span<std::vector<double>>) {};
  EXPECT_TRUE(filter_rotations({}, nothing).empty());
  const Rotations one{kJoint};
  EXPECT_LT(largest_difference(filter_rotations(one, nothing), one), 1e-15);
}

}  // namespace
}  // namespace marey::edit
