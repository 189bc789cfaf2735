// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace marey::dynamics {

/// The captured push of one axis, in the form from which another is derived.
/// Preparation is done once; deriving pushes from it allocates nothing.
struct PushReference {
  double duration_s = 0.0;
  /// Force per kilogram at equally spaced times from 0 to duration_s, linear in between;
  /// at least 2. Vertical: acceleration plus gravity, not negative. [m/s^2]
  std::vector<double> force_m_s2;
  /// Running integrals of the force, at the same times: once and twice.
  std::vector<double> impulse_m_s;
  std::vector<double> double_impulse_m;
};
/// Computes the integrals exactly. Precondition: duration_s above 0; at least 2 forces.
[[nodiscard]] PushReference make_push_reference(double duration_s,
                                                std::vector<double> force_m_s2);

/// Place of x = t / duration in a reference: `w` is 0 to 1 after sample `index`.
struct SamplePlace {
  std::size_t index = 0;
  double w = 0.0;
};
[[nodiscard]] inline SamplePlace sample_of(const PushReference& reference, double x) {
  const std::size_t last = reference.force_m_s2.size() - 2;
  const double scaled = x * static_cast<double>(last + 1);
  const auto index = std::min(static_cast<std::size_t>(std::max(scaled, 0.0)), last);
  return {index, scaled - static_cast<double>(index)};
}

/// Returns the force at x. [m/s^2]
[[nodiscard]] inline double reference_force(const PushReference& reference, double x) {
  const auto [i, w] = sample_of(reference, x);
  const auto& f = reference.force_m_s2;
  return f[i] + w * (f[i + 1] - f[i]);
}

/// Returns the integral of the force over x, from 0 to x. [m/s^2]
[[nodiscard]] inline double reference_once(const PushReference& reference, double x) {
  const auto [i, w] = sample_of(reference, x);
  const auto& f = reference.force_m_s2;
  const double width = 1.0 / static_cast<double>(f.size() - 1);
  return reference.impulse_m_s[i] / reference.duration_s +
         width * w * (f[i] + 0.5 * w * (f[i + 1] - f[i]));
}

/// Returns the integral of reference_once() over x, from 0 to x. [m/s^2]
[[nodiscard]] inline double reference_twice(const PushReference& reference, double x) {
  const auto [i, w] = sample_of(reference, x);
  const auto& f = reference.force_m_s2;
  const double width = 1.0 / static_cast<double>(f.size() - 1);
  const double t = reference.duration_s;
  return reference.double_impulse_m[i] / (t * t) +
         width * w *
             (reference.impulse_m_s[i] / t +
              width * w * (f[i] / 2.0 + w * (f[i + 1] - f[i]) / 6.0));
}

}  // namespace marey::dynamics
