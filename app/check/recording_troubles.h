// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"

namespace marey::app {

/// What was found wrong with a trial's recording, though it could be used.
struct RecordingTroubles {
  std::vector<std::string> warnings;
  /// Something is missing that should be there: the rest goes on without it.
  std::vector<Error> failures;
};

}  // namespace marey::app
