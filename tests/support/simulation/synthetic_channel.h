// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <span>
#include <vector>

namespace marey::testing {

/// Returns a sum of eight sines with random phases and frequencies up to `band_hz`, whose
/// amplitudes fall with the frequency as those of movements do.
inline std::vector<double> band_limited(std::size_t samples,
                                        double rate_hz,
                                        double band_hz,
                                        unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<double> channel(samples, 0.0);
  for (int k = 0; k < 8; ++k) {
    const double frequency_hz = band_hz * (k + unit(random)) / 8.0;
    const double phase = 2.0 * std::numbers::pi * unit(random);
    const double amplitude = 0.2 / (1.0 + k * k);
    for (std::size_t i = 0; i < samples; ++i) {
      const double t = static_cast<double>(i) / rate_hz;
      channel[i] +=
          amplitude * std::sin(2.0 * std::numbers::pi * frequency_hz * t + phase);
    }
  }
  return channel;
}

/// Returns the channel with white Gaussian noise.
inline std::vector<double> with_noise(std::vector<double> channel,
                                      double sigma,
                                      unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, sigma);
  for (double& value : channel) value += noise(random);
  return channel;
}

/// Root mean square of the difference.
inline double rms_difference(std::span<const double> a, std::span<const double> b) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(squares / static_cast<double>(a.size()));
}

}  // namespace marey::testing
