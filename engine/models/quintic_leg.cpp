// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/models/quintic_leg.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::engine {

Motion3 QuinticLeg::at(double time_s) const {
  const double x = (time_s - start_s) / length_s;
  const double per_s = 1.0 / length_s;
  Motion3 motion;
  motion.value = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
  motion.rate =
      per_s *
      (c[1] + x * (2.0 * c[2] + x * (3.0 * c[3] + x * (4.0 * c[4] + x * 5.0 * c[5]))));
  motion.acceleration =
      per_s * per_s *
      (2.0 * c[2] + x * (6.0 * c[3] + x * (12.0 * c[4] + x * 20.0 * c[5])));
  return motion;
}

double QuinticLeg::max_acceleration() const {
  constexpr int kInstants = 16;
  double max_squared = 0.0;
  for (int i = 0; i <= kInstants; ++i) {
    const double x = static_cast<double>(i) / kInstants;
    const glm::dvec3 a =
        2.0 * c[2] + x * (6.0 * c[3] + x * (12.0 * c[4] + x * 20.0 * c[5]));
    max_squared = std::max(max_squared, glm::dot(a, a));
  }
  return std::sqrt(max_squared) / (length_s * length_s);
}

QuinticLeg quintic_leg(double start_s,
                       double length_s,
                       const Motion3& from,
                       const Motion3& to) {
  MAREY_ASSERT(length_s > 0.0);
  const double h = length_s;
  QuinticLeg leg;
  leg.start_s = start_s;
  leg.length_s = length_s;
  leg.c[0] = from.value;
  leg.c[1] = h * from.rate;
  leg.c[2] = 0.5 * h * h * from.acceleration;
  const glm::dvec3 value = to.value - leg.c[0] - leg.c[1] - leg.c[2];
  const glm::dvec3 rate = h * to.rate - leg.c[1] - 2.0 * leg.c[2];
  const glm::dvec3 acceleration = h * h * to.acceleration - 2.0 * leg.c[2];
  leg.c[3] = 10.0 * value - 4.0 * rate + 0.5 * acceleration;
  leg.c[4] = -15.0 * value + 7.0 * rate - acceleration;
  leg.c[5] = 6.0 * value - 3.0 * rate + 0.5 * acceleration;
  return leg;
}

}  // namespace marey::engine
