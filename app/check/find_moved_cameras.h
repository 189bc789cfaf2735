// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"

namespace marey::app {

/// What a trial shows of a camera that stands elsewhere than its calibration says.
struct MovedFinding {
  Error error;           ///< kQuality, with the amount, since when, and what to do.
  bool is_poor = false;  ///< Too much to be trusted; else a warning.
};

/// Tests the cameras in a trial, from its tags alone. `detections` one entry per camera,
/// shrinkage taken off. nullopt where all stand where they did, or nothing tells.
[[nodiscard]] std::optional<MovedFinding> find_moved_cameras(
    const std::string& trial,
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    std::span<const TagOnSegment> tags);

}  // namespace marey::app
