// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"

namespace marey::app {

/// Exit codes of every command (docs/formats/exit_codes.md).
enum class Exit {
  kOk = 0,
  kInternal = 1,
  kUsage = 2,
  kBadInput = 3,
  kQualityGate = 4,
  kDevice = 5,
  kInterrupted = 130,
};

[[nodiscard]] Exit exit_for(Errc code);

}  // namespace marey::app
