// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/figures/mean_jerk.h"

#include <utility>

#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::app {

void MeanJerk::add(std::span<const glm::dvec3> points_in_world) {
  if (known_ >= 3) {
    MAREY_ASSERT(points_in_world.size() == last_[0].size());
    const double cube_s3 = step_s_ * step_s_ * step_s_;
    for (std::size_t i = 0; i < points_in_world.size(); ++i) {
      const glm::dvec3 difference =
          points_in_world[i] - 3.0 * last_[0][i] + 3.0 * last_[1][i] - last_[2][i];
      sum_ += glm::length(difference) / cube_s3;
      ++count_;
    }
  }
  std::swap(last_[1], last_[2]);
  std::swap(last_[0], last_[1]);
  last_[0].assign(points_in_world.begin(), points_in_world.end());
  ++known_;
}

}  // namespace marey::app
