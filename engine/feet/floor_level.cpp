// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/feet/floor_level.h"

#include <cmath>

namespace marey::engine {

double FloorLevel::step(std::optional<double> sole_height_m,
                        double max_m,
                        double step_s) {
  const bool counts = sole_height_m && std::abs(*sole_height_m + lift_m_) <= max_m;
  const bool is_first = !is_known_;
  is_known_ = true;
  if (counts && is_first) {
    lift_m_ = -*sole_height_m;
    return lift_m_;
  }
  const double y = 1.0 / kTime_s;
  const double e = std::exp(-y * step_s);
  if (!counts) {
    // The remaining velocity decays.
    lift_m_ += rate_m_s_ * (1.0 - e) / y;
    rate_m_s_ *= e;
    return lift_m_;
  }
  const double off_m = lift_m_ + *sole_height_m;
  const double j = rate_m_s_ + off_m * y;
  lift_m_ = (off_m + j * step_s) * e - *sole_height_m;
  rate_m_s_ = (rate_m_s_ - j * y * step_s) * e;
  return lift_m_;
}

}  // namespace marey::engine
