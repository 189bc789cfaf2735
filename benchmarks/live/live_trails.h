// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "tests/support/truth/truth.h"

namespace marey::benchmarks {

struct LiveTrail {
  const char* pictures = "";  ///< Which of them were used.
  double delay_ms = 0.0;      ///< By how much the body trails the truth of their stamps.
};

/// Follows a body through a trial as `marey live` does, no camera being the reference,
/// with all pictures and with half of them passed over in three ways. Joints that the
/// tracker knows to 20 mm count, from one second on. Errors: the tracker's.
[[nodiscard]] Result<std::vector<LiveTrail>> live_trails(
    const Body& body,
    std::span<const Camera> cameras,
    const testing::TruthJoints& truth,
    std::span<const CameraDetections> detections);

}  // namespace marey::benchmarks
