// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace marey::reconstruct {

/// Returns the value at the rank nearest to `share` (0: minimum, 1: maximum).
/// Precondition: there is a value.
[[nodiscard]] inline double nearest_quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return values[static_cast<std::size_t>(std::lround(share * last))];
}

}  // namespace marey::reconstruct
