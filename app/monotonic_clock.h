// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "core/time.h"

namespace marey::app {

/// Now, on the clock of the cameras' stamps: libstdc++'s steady clock is CLOCK_MONOTONIC.
[[nodiscard]] inline Timestamp monotonic_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

}  // namespace marey::app
