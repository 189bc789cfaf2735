// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace marey::recordings {

/// Returns the exact rate of a file that stores it rounded: the nearest whole number
/// within 1e-4 (relative), which is the precision of six digits; else the nearest
/// thousandth or 1001st of a whole thousand (30000 / 1001) within `exact` of `hz`,
/// relatively; else `hz` itself. Precondition: hz > 0.
[[nodiscard]] inline double nominal_rate(double hz, double exact) {
  const double whole = std::round(hz);
  if (whole > 0.0 && std::abs(hz - whole) < 1e-4 * hz) return whole;
  const double thousandths = std::round(1000.0 * hz) / 1000.0;
  const double film = std::round(1.001 * hz) * 1000.0 / 1001.0;
  const bool is_film = std::abs(hz - film) < std::abs(hz - thousandths);
  const double nearest = is_film ? film : thousandths;
  return std::abs(hz - nearest) < exact * hz ? nearest : hz;
}

}  // namespace marey::recordings
