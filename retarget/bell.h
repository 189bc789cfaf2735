// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace marey::retarget {

/// (1 - x^2)^3, 1 at 0 and 0 at -1 and 1, with two continuous derivatives there: what is
/// averaged with it over time is smooth. Precondition: |x| <= 1.
[[nodiscard]] inline double bell(double x) {
  return (1.0 - x * x) * (1.0 - x * x) * (1.0 - x * x);
}

/// Weights of the frames -half to half about one; those beyond weigh nothing.
/// Precondition: half >= 0.
[[nodiscard]] inline std::vector<double> bell_weights(int half) {
  std::vector<double> weights;
  for (int k = -half; k <= half; ++k) {
    weights.push_back(bell(static_cast<double>(k) / (half + 1)));
  }
  return weights;
}

}  // namespace marey::retarget
