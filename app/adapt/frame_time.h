// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/motion.h"

namespace marey::app {

/// Returns the time of a frame of a motion; frames count from 0. [s]
[[nodiscard]] inline double frame_time_s(const Motion& motion, int frame) {
  return (motion.first_frame + frame) / motion.rate.hz;
}

}  // namespace marey::app
