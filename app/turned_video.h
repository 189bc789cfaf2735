// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/result.h"

namespace marey::app {

/// Of a trial whose cameras disagree on the tags (reconstruct::check_views()): the video
/// that is upside down against its camera's calibration, with which all would agree.
/// nullopt if there is none. Detections one per camera, shrinkage taken off. Cost: that of
/// check_views() for each camera.
[[nodiscard]] std::optional<Error> find_turned_video(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    std::span<const TagOnSegment> tags);

}  // namespace marey::app
