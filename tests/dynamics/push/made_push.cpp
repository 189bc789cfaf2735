// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/dynamics/push/made_push.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace marey::dynamics {

MadePush made_push(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  const double duration_s = between(0.5, 0.9);
  const int samples = 40 + static_cast<int>(between(0.0, 60.0));
  const double start_m_s = seed % 2 == 0 ? 0.0 : between(-2.5, -1.0);
  const double first_m_s2 = seed % 2 == 0 ? kStandardGravity_m_s2 : 0.0;
  const double push_at = between(0.55, 0.75);
  const double width = between(0.18, 0.28);
  const double ripple = between(0.0, 1.5);
  const double ripples = between(15.0, 35.0);
  std::vector<double> shape;
  for (int i = 0; i < samples; ++i) {
    const double x = static_cast<double>(i) / (samples - 1);
    const double unload = first_m_s2 * (1.0 - std::min(1.0, x / 0.2));
    const double rise = std::min(1.0, x / 0.3);
    const double bump = std::exp(-std::pow((x - push_at) / width, 2.0));
    const double fade = std::min(1.0, (1.0 - x) / 0.12);
    const double force =
        unload + rise * (2.0 + 20.0 * bump + ripple * (1.0 + std::sin(ripples * x)));
    shape.push_back(std::max(0.0, force * fade));
  }
  // Scaled to the impulse of a jump that rises by 0.2 to 0.5 m.
  const double end_m_s = std::sqrt(2.0 * kStandardGravity_m_s2 * between(0.2, 0.5));
  const double wanted_m_s = end_m_s - start_m_s + kStandardGravity_m_s2 * duration_s;
  const double given_m_s = make_push_reference(duration_s, shape).impulse_m_s.back();
  for (double& force : shape) force *= wanted_m_s / given_m_s;

  MadePush out{make_push_reference(duration_s, std::move(shape)), {}, 0.0};
  out.ends.start_m_s = start_m_s;
  out.ends.duration_s = duration_s;
  out.ends.end_m_s =
      start_m_s + out.reference.impulse_m_s.back() - kStandardGravity_m_s2 * duration_s;
  out.ends.end_m = start_m_s * duration_s + out.reference.double_impulse_m.back() -
                   0.5 * kStandardGravity_m_s2 * duration_s * duration_s;
  out.peak_m_s2 =
      *std::max_element(out.reference.force_m_s2.begin(), out.reference.force_m_s2.end());
  return out;
}

PushEnds changed_ends(const MadePush& made, unsigned seed) {
  std::mt19937 random(seed + 1000);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  PushEnds out = made.ends;
  out.end_m_s *= std::sqrt(between(0.25, 2.0));
  out.end_m += between(-0.04, 0.04);
  out.duration_s *= between(0.8, 1.2);
  return out;
}

}  // namespace marey::dynamics
