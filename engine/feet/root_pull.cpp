// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/feet/root_pull.h"

#include <cmath>

namespace marey::engine {

glm::dvec2 RootPull::step(const glm::dvec2& away_m, double step_s) {
  const double y = 1.0 / kTime_s;
  const double e = std::exp(-y * step_s);
  const glm::dvec2 off_m = -away_m;
  const glm::dvec2 j = rate_m_s_ + off_m * y;
  rate_m_s_ = (rate_m_s_ - j * (y * step_s)) * e;
  return (off_m + j * step_s) * e - off_m;
}

}  // namespace marey::engine
