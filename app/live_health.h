// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/live_figures.h"
#include "live/page_status.h"

namespace marey::app {

/// How a camera fares, as the page tells it: `before` is what was told of it last, or
/// null. A camera streams whose pictures have come since; of one whose pictures have not,
/// its own trouble says whether it is lost.
[[nodiscard]] live::PageCameraStatus camera_status(const LiveCameraFigures& now,
                                                   const LiveCameraFigures* before,
                                                   int tags);

/// How an output fares, likewise: trouble counts while there is some, not for ever.
[[nodiscard]] live::PageOutput output_status(const OutputCounts& now,
                                             const OutputCounts* before);

}  // namespace marey::app
