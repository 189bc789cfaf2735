// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/sway_spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include <glm/gtc/constants.hpp>

#include "core/base/assert.h"

namespace marey::app {
namespace {

constexpr double kFirstBand_hz = 0.25;
constexpr double kBandsPerOctave = 3.0;

/// Removes the mean and applies a Hann window of mean square 1.
std::vector<double> windowed(std::span<const double> signal) {
  double mean = 0.0;
  for (const double value : signal) mean += value;
  mean /= static_cast<double>(signal.size());
  std::vector<double> out;
  out.reserve(signal.size());
  const double turn = glm::two_pi<double>() / static_cast<double>(signal.size());
  for (std::size_t i = 0; i < signal.size(); ++i) {
    const double hann = 0.5 - 0.5 * std::cos(turn * (static_cast<double>(i) + 0.5));
    out.push_back((signal[i] - mean) * hann / std::sqrt(0.375));
  }
  return out;
}

/// Mean square of the part of a signal at `cycles` cycles in its length.
double power_at(std::span<const double> signal, std::size_t cycles) {
  const double n = static_cast<double>(signal.size());
  const double turn = glm::two_pi<double>() * static_cast<double>(cycles) / n;
  const std::complex<double> rotation = std::polar(1.0, -turn);
  std::complex<double> phase(1.0, 0.0);
  std::complex<double> sum(0.0, 0.0);
  for (const double value : signal) {
    sum += value * phase;
    phase *= rotation;
  }
  return 2.0 * std::norm(sum) / (n * n);
}

void add_to_bands(double power, double frequency_hz, SwayBands& bands) {
  const double place = kBandsPerOctave * std::log2(frequency_hz / kFirstBand_hz);
  const double low = std::floor(place);
  const double share = place - low;
  const auto add = [&](double band, double part) {
    if (band < 0.0 || band > static_cast<double>(kSwayBands) - 1.0) return;
    bands[static_cast<std::size_t>(band)] += part * power;
  };
  add(low, 1.0 - share);
  add(low + 1.0, share);
}

}  // namespace

double lateral_lean_rad(const glm::dvec3& hips_in_world,
                        const glm::dvec3& neck_in_world,
                        double heading_rad) {
  const glm::dvec3 along = neck_in_world - hips_in_world;
  const double left_m = along.x * std::cos(heading_rad) - along.z * std::sin(heading_rad);
  return std::atan2(left_m, along.y);
}

SwayBands sway_bands(std::span<const double> signal, double step_s) {
  MAREY_ASSERT(step_s > 0.0);
  SwayBands powers{};
  if (signal.size() < 2) return powers;
  const std::vector<double> values = windowed(signal);
  const double length_s = step_s * static_cast<double>(values.size());
  const double last_hz =
      kFirstBand_hz * std::exp2(static_cast<double>(kSwayBands) / kBandsPerOctave);
  for (std::size_t cycles = 1; 2 * cycles < values.size(); ++cycles) {
    const double frequency_hz = static_cast<double>(cycles) / length_s;
    if (frequency_hz >= last_hz) break;
    add_to_bands(power_at(values, cycles), frequency_hz, powers);
  }
  for (double& power : powers) power = std::sqrt(power);
  return powers;
}

void SwaySpectrum::add(std::span<const double> signal, double step_s) {
  const double length_s = step_s * static_cast<double>(signal.size());
  const SwayBands bands = sway_bands(signal, step_s);
  for (std::size_t band = 0; band < kSwayBands; ++band) {
    powers_[band] += length_s * bands[band] * bands[band];
  }
  duration_s_ += length_s;
}

SwayBands SwaySpectrum::bands() const {
  MAREY_ASSERT(duration_s_ > 0.0);
  SwayBands bands{};
  for (std::size_t band = 0; band < kSwayBands; ++band) {
    bands[band] = std::sqrt(powers_[band] / duration_s_);
  }
  return bands;
}

double spectrum_deviation_percent(const SwayBands& of, const SwayBands& from) {
  double difference = 0.0;
  double size = 0.0;
  for (std::size_t band = 0; band < kSwayBands; ++band) {
    difference += (of[band] - from[band]) * (of[band] - from[band]);
    size += from[band] * from[band];
  }
  MAREY_ASSERT(size > 0.0);
  return 100.0 * std::sqrt(difference / size);
}

}  // namespace marey::app
