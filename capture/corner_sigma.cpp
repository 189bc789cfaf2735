// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/detect_tags.h"

namespace marey::capture {

double corner_sigma_px(double side_px) {
  MAREY_ASSERT(side_px > 0.0);
  return 0.2;
}

}  // namespace marey::capture
