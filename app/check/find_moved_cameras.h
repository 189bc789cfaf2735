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

/// Camera that was moved after its calibration, or during a trial.
struct MovedFinding {
  Error error;           ///< kQuality, with amount, first frame and next step.
  bool is_poor = false;  ///< The trial cannot be trusted; else a warning.
};

/// Detects a moved camera in a trial, from the tags alone. `detections` has one entry per
/// camera, corrected for shrinkage. nullopt if no camera was moved, or if the tags are
/// too few for the test.
[[nodiscard]] std::optional<MovedFinding> find_moved_cameras(
    const std::string& trial,
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    std::span<const TagOnSegment> tags);

}  // namespace marey::app
