// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/detection.h"
#include "core/ids.h"
#include "core/time.h"

namespace marey {

/// What one camera saw of an instant, as detected: shrinkage is still on it.
struct CameraTags {
  CameraId camera{};
  Timestamp time{0};  ///< When its picture was taken, on the clock that all share.
  std::vector<TagDetection> tags;  ///< Ascending ids, each at most once.
};

/// What all cameras saw of one instant: all that a live solve knows of it.
struct LiveInstant {
  std::int64_t number = 0;  ///< Of the grid of instants; grows, with gaps where none came.
  Timestamp time{0};        ///< On the same clock as the views'.
  std::vector<CameraTags> views;  ///< Ascending cameras, each at most once.
};

}  // namespace marey
