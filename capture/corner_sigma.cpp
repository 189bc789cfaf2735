// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "capture/detect_tags.h"

namespace marey::capture {

double corner_sigma_px(double side_px) {
  MAREY_ASSERT(side_px > 0.0);
  const double small = 6.5 / side_px;
  return std::hypot(0.1, small * small);
}

}  // namespace marey::capture
