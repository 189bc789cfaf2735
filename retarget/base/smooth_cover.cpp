// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/base/smooth_cover.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "retarget/base/triweight.h"

namespace marey::retarget {

std::vector<double> smooth_cover(std::span<const double> needed, int half) {
  const int count = static_cast<int>(needed.size());
  std::vector<double> out(needed.size(), 0.0);
  if (std::all_of(needed.begin(), needed.end(), [](double x) { return x <= 0.0; })) {
    return out;
  }
  const std::vector<double> weights = triweight_weights(half);
  const double sum_of_weights = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<double> peak(needed.size());
  for (int t = 0; t < count; ++t) {
    const auto from = needed.begin() + std::max(0, t - half);
    const auto to = needed.begin() + std::min(count - 1, t + half) + 1;
    peak[static_cast<std::size_t>(t)] = *std::max_element(from, to);
  }
  for (int t = 0; t < count; ++t) {
    double sum = 0.0;
    for (int k = -half; k <= half; ++k) {
      sum += weights[static_cast<std::size_t>(k + half)] *
             peak[static_cast<std::size_t>(std::clamp(t + k, 0, count - 1))];
    }
    out[static_cast<std::size_t>(t)] = sum / sum_of_weights;
  }
  return out;
}

}  // namespace marey::retarget
