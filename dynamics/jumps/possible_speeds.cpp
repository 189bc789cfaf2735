// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "dynamics/jumps/possible_speeds.h"

namespace marey::dynamics {
namespace {

constexpr int kTriedSpeeds = 96;
constexpr double kSpeedTolerance_m_s = 1e-4;

}  // namespace

std::optional<EndSpeeds> possible_speeds(const SupportReference& reference,
                                         SupportWish wish,
                                         double largest_m_s) {
  const auto is_possible = [&](double speed_m_s) {
    wish.end.velocity_m_s.y = speed_m_s;
    return derive_support(reference, wish).has_value();
  };
  const double step_m_s = largest_m_s / kTriedSpeeds;
  std::optional<EndSpeeds> out;
  for (int k = 1; k <= kTriedSpeeds; ++k) {
    const double speed_m_s = k * step_m_s;
    if (!is_possible(speed_m_s)) continue;
    if (!out) out = EndSpeeds{speed_m_s, speed_m_s};
    out->high_m_s = speed_m_s;
  }
  // Half steps outwards from speeds that are possible.
  double half_m_s = 0.5 * step_m_s;
  for (; out && half_m_s > kSpeedTolerance_m_s; half_m_s *= 0.5) {
    if (is_possible(out->low_m_s - half_m_s)) out->low_m_s -= half_m_s;
    if (is_possible(out->high_m_s + half_m_s)) out->high_m_s += half_m_s;
  }
  return out;
}

}  // namespace marey::dynamics
