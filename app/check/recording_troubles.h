// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"

namespace marey::app {

/// Problems of a trial's recording that did not prevent its use.
struct RecordingTroubles {
  std::vector<std::string> warnings;
  /// Problems with missing data: the trial is processed without the data.
  std::vector<Error> failures;
};

}  // namespace marey::app
