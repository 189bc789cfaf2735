// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/motion.h"

namespace marey::app {

/// Returns the time of a frame, counted from 0, of a motion. [s]
[[nodiscard]] inline double frame_time_s(const Motion& motion, int frame) {
  return (motion.first_frame + frame) / motion.rate.hz;
}

}  // namespace marey::app
