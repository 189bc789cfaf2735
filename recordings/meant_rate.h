// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace marey::recordings {

/// The rate that a file means whose own word for it is rounded: the nearest whole number
/// if it is within 1e-4, which is what six digits leave of it; else, of thousandths and
/// of 1001sts of whole thousands (30000 / 1001), the one that `hz` is within `exact` of,
/// relatively; else `hz` itself. Precondition: hz > 0.
[[nodiscard]] inline double meant_rate(double hz, double exact) {
  const double whole = std::round(hz);
  if (whole > 0.0 && std::abs(hz - whole) < 1e-4 * hz) return whole;
  const double thousandths = std::round(1000.0 * hz) / 1000.0;
  const double film = std::round(1.001 * hz) * 1000.0 / 1001.0;
  const bool is_film = std::abs(hz - film) < std::abs(hz - thousandths);
  const double nearest = is_film ? film : thousandths;
  return std::abs(hz - nearest) < exact * hz ? nearest : hz;
}

}  // namespace marey::recordings
