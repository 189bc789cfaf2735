// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "core/base/time.h"

namespace marey {

/// Returns the present time on the clock of camera time stamps: the steady clock of
/// libstdc++ is CLOCK_MONOTONIC.
[[nodiscard]] inline Timestamp monotonic_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

}  // namespace marey
