// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/finding.h"

namespace marey::app {

/// Detects a camera that was moved after its calibration or during a trial, from the tags
/// alone. The finding has the amount and the first frame. `detections` has one entry per
/// camera, corrected for shrinkage. nullopt if no camera was moved, or if the tags are
/// too few for the test.
[[nodiscard]] std::optional<Finding> assess_moved_camera(
    const std::string& trial,
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    std::span<const TagOnSegment> tags);

}  // namespace marey::app
