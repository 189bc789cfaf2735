// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace marey::app {

/// Bands of a spectrum: middles a third of an octave apart, from 0.25 to 4 Hz.
inline constexpr std::size_t kSwayBands = 13;
/// Root of the mean square of a signal in each band.
using SwayBands = std::array<double, kSwayBands>;

/// Returns the lean of the line from hips to neck to the side: its angle from the
/// vertical in the plane across the heading. [rad] Positive is towards the left.
[[nodiscard]] double lateral_lean_rad(const glm::dvec3& hips_in_world,
                                      const glm::dvec3& neck_in_world,
                                      double heading_rad);

/// Computes the spectrum of a signal with a steady step, without its mean (Hann window).
/// Each frequency counts in both neighbouring bands, by its distance in octaves: a small
/// change of frequency changes the bands little. Quadratic in samples at most; 4 Hz and
/// the duration bound the frequencies. Precondition: step_s > 0.
[[nodiscard]] SwayBands sway_bands(std::span<const double> signal, double step_s);

/// Collects the spectra of several pieces, each weighted by its duration.
class SwaySpectrum {
 public:
  void add(std::span<const double> signal, double step_s);
  [[nodiscard]] double duration_s() const { return duration_s_; }
  /// Precondition: duration_s() > 0.
  [[nodiscard]] SwayBands bands() const;

 private:
  SwayBands powers_{};
  double duration_s_ = 0.0;
};

/// Returns the distance of two spectra over the size of the second one: the root of the
/// sum of squares over all bands. [percent] Precondition: the second one is not zero.
[[nodiscard]] double spectrum_deviation_percent(const SwayBands& of,
                                                const SwayBands& from);

}  // namespace marey::app
