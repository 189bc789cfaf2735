// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace marey::retarget {

/// Returns the triweight kernel (1 - x^2)^3 without its normalization: 1 at 0, and 0 with
/// two continuous derivatives at -1 and 1, so that averages with it over time are smooth.
/// Precondition: |x| <= 1.
[[nodiscard]] inline double triweight(double x) {
  return (1.0 - x * x) * (1.0 - x * x) * (1.0 - x * x);
}

/// Returns the weights of the frames -half to half about one; others have weight 0.
/// Precondition: half >= 0.
[[nodiscard]] inline std::vector<double> triweight_weights(int half) {
  std::vector<double> weights;
  for (int k = -half; k <= half; ++k) {
    weights.push_back(triweight(static_cast<double>(k) / (half + 1)));
  }
  return weights;
}

}  // namespace marey::retarget
