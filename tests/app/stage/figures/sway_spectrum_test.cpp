// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/sway_spectrum.h"

#include <cmath>
#include <random>

#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace marey::app {
namespace {

std::vector<double> sine(double frequency_hz,
                         double amplitude,
                         double phase_rad,
                         int samples) {
  std::vector<double> out;
  for (int i = 0; i < samples; ++i) {
    const double angle = glm::two_pi<double>() * frequency_hz * i / 60.0 + phase_rad;
    out.push_back(0.3 + amplitude * std::sin(angle));
  }
  return out;
}

TEST(SwaySpectrum, ASineIsInTheBandOfItsFrequency) {
  for (const std::size_t band : {3U, 6U, 9U}) {
    const double frequency_hz = 0.25 * std::exp2(static_cast<double>(band) / 3.0);
    const SwayBands bands = sway_bands(sine(frequency_hz, 0.2, 0.4, 6000), 1.0 / 60);
    double power = 0.0;
    for (const double value : bands) power += value * value;
    EXPECT_NEAR(std::sqrt(power), 0.2 / std::sqrt(2.0), 0.001);
    EXPECT_GT(bands[band] * bands[band], 0.9 * power);
  }
}

TEST(SwaySpectrum, TheMeanAndThePhaseHaveNoEffect) {
  const SwayBands from = sway_bands(sine(0.85, 0.1, 0.0, 1800), 1.0 / 60);
  for (const double phase : {0.7, 2.0, 4.0}) {
    const SwayBands of = sway_bands(sine(0.85, 0.1, phase, 1800), 1.0 / 60);
    EXPECT_LT(spectrum_deviation_percent(of, from), 1.0);
  }
}

TEST(SwaySpectrum, HalfTheAmplitudeDeviatesByHalf) {
  const SwayBands from = sway_bands(sine(1.0, 0.2, 0.0, 1200), 1.0 / 60);
  const SwayBands of = sway_bands(sine(1.0, 0.1, 0.0, 1200), 1.0 / 60);
  EXPECT_NEAR(spectrum_deviation_percent(of, from), 50.0, 1e-6);
  EXPECT_NEAR(spectrum_deviation_percent(SwayBands{}, from), 100.0, 1e-9);
}

TEST(SwaySpectrum, ASmallChangeOfFrequencyDeviatesLittle) {
  const SwayBands from = sway_bands(sine(1.0, 0.2, 0.0, 3600), 1.0 / 60);
  const SwayBands near = sway_bands(sine(1.01, 0.2, 0.0, 3600), 1.0 / 60);
  const SwayBands far = sway_bands(sine(1.3, 0.2, 0.0, 3600), 1.0 / 60);
  EXPECT_LT(spectrum_deviation_percent(near, from), 20.0);
  EXPECT_GT(spectrum_deviation_percent(far, from), 80.0);
}

TEST(SwaySpectrum, PiecesAddUpToTheWhole) {
  const auto whole = sine(0.9, 0.15, 0.0, 2400);
  SwaySpectrum pieces;
  pieces.add(std::span(whole).first(1200), 1.0 / 60);
  pieces.add(std::span(whole).last(1200), 1.0 / 60);
  EXPECT_NEAR(pieces.duration_s(), 40.0, 1e-9);
  const SwayBands from = sway_bands(whole, 1.0 / 60);
  EXPECT_LT(spectrum_deviation_percent(pieces.bands(), from), 10.0);
}

TEST(SwaySpectrum, LeanIsMeasuredAcrossTheHeading) {
  const glm::dvec3 hips(1.0, 1.0, 2.0);
  for (const double heading_deg : {0.0, 60.0, 200.0}) {
    const double heading_rad = glm::radians(heading_deg);
    const glm::dvec3 left(std::cos(heading_rad), 0.0, -std::sin(heading_rad));
    const glm::dvec3 ahead(std::sin(heading_rad), 0.0, std::cos(heading_rad));
    const glm::dvec3 neck = hips + glm::dvec3(0, 0.5, 0) + 0.1 * left + 0.3 * ahead;
    EXPECT_NEAR(lateral_lean_rad(hips, neck, heading_rad), std::atan2(0.1, 0.5), 1e-12);
  }
}

TEST(SwaySpectrum, ShortSignalsHaveNoSpectrum) {
  EXPECT_EQ(sway_bands({}, 1.0 / 60), SwayBands{});
  const std::vector<double> one{1.0};
  EXPECT_EQ(sway_bands(one, 1.0 / 60), SwayBands{});
}

}  // namespace
}  // namespace marey::app
