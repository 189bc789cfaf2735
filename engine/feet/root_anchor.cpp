// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/feet/root_anchor.h"

#include <algorithm>
#include <cmath>

#include "core/base/smooth_step.h"

namespace marey::engine {
namespace {

glm::dvec3 part_of(const FootPlaces& feet, std::size_t part) {
  return part % 2 == 0 ? feet.ankle[part / 2] : feet.ball[part / 2];
}

}  // namespace

void RootAnchor::observe(const PerFootPart& bears, double step_s) {
  const double share = is_known_ ? 1.0 - std::exp(-step_s / kSmoothing_s) : 1.0;
  is_known_ = true;
  for (std::size_t i = 0; i < bears.size(); ++i) {
    bears_[i] += share * (bears[i] - bears_[i]);
  }
}

RootPlace RootAnchor::displacement(const RootPlace& blended_m,
                                   const FootPlaces& before_legs,
                                   const FootPlaces& now_legs,
                                   double leg_length_m,
                                   double strength) const {
  const double c = std::cos(blended_m.heading_rad);
  const double s = std::sin(blended_m.heading_rad);
  double sum = 0.0;
  double x = 0.0;
  double z = 0.0;
  for (std::size_t i = 0; i < bears_.size(); ++i) {
    const glm::dvec3 was = part_of(before_legs, i);
    const glm::dvec3 is = part_of(now_legs, i);
    sum += bears_[i];
    x += bears_[i] * (was.x - (c * is.x + s * is.z));
    z += bears_[i] * (was.z - (c * is.z - s * is.x));
  }
  if (sum < 1e-9 || strength <= 0.0) return blended_m;
  const double share = strength * smooth_step(std::min(1.0, sum));
  const double unit = leg_length_m / sum;
  RootPlace out = blended_m;
  out.x_m += share * (unit * x - blended_m.x_m);
  out.z_m += share * (unit * z - blended_m.z_m);
  return out;
}

}  // namespace marey::engine
