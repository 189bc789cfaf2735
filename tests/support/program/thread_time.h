// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>

namespace marey::testing {

/// Returns the processor time of this thread [s]: unlike wall-clock time, it does not
/// depend on the load of the machine.
[[nodiscard]] inline double thread_time_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace marey::testing
