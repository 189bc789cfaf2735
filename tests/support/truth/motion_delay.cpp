// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/truth/motion_delay.h"

#include <limits>

#include <glm/geometric.hpp>

namespace marey::testing {

double delay_s(std::span<const std::vector<TimedPlace>> joints,
               const std::function<glm::dvec3(std::size_t, double)>& truth) {
  std::vector<glm::dvec3> off;
  const auto spread = [&](double delay_s) {
    double sum = 0.0;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      off.clear();
      glm::dvec3 mean(0.0);
      for (const TimedPlace& one : joints[j]) {
        off.push_back(one.p_in_world - truth(j, one.time_s - delay_s));
        mean += off.back() / static_cast<double>(joints[j].size());
      }
      for (const glm::dvec3& one : off) sum += glm::dot(one - mean, one - mean);
    }
    return sum;
  };
  constexpr double kMax_s = 0.06;
  constexpr double kStep_s = 0.004;
  double best_s = 0.0;
  double minimum = std::numeric_limits<double>::infinity();
  for (double delay_s = -kMax_s; delay_s <= kMax_s; delay_s += kStep_s) {
    const double here = spread(delay_s);
    if (here >= minimum) continue;
    minimum = here;
    best_s = delay_s;
  }
  double low_s = best_s - kStep_s;
  double high_s = best_s + kStep_s;
  for (int i = 0; i < 20; ++i) {
    const double third_s = (high_s - low_s) / 3.0;
    if (spread(low_s + third_s) < spread(high_s - third_s)) {
      high_s -= third_s;
    } else {
      low_s += third_s;
    }
  }
  return 0.5 * (low_s + high_s);
}

}  // namespace marey::testing
