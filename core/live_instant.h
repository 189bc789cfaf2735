// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/ids.h"
#include "core/base/time.h"
#include "core/detection.h"

namespace marey {

/// Tags that one camera saw at one instant, as detected: shrinkage is not removed.
struct CameraTags {
  CameraId camera{};
  Timestamp time{0};  ///< Time of its picture, on the common clock of all cameras.
  std::vector<TagDetection> tags;  ///< Ascending ids, each at most once.
};

/// Tags that all cameras saw at one instant: the whole input of a live solve.
struct LiveInstant {
  /// On the grid of instants; ascending, with gaps where none arrived.
  std::int64_t number = 0;
  Timestamp time{0};              ///< On the same clock as the views'.
  std::vector<CameraTags> views;  ///< Ascending cameras, each at most once.
};

}  // namespace marey
