// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "app/pages/report.h"
#include "core/base/result.h"
#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/motion.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Returns a few frames of the trial's videos, spread over time and cameras, with the
/// solved skeleton and the detected tags drawn over them. `detections` has one entry per
/// camera, with the corners as detected. Errors: a video can no longer be read.
[[nodiscard]] Result<std::vector<ReportPicture>> draw_frames(
    const recordings::Trial& trial,
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    const EstimatedMotion& estimate);

/// Counts the cameras that saw each tag, for every frame of `motion`.
[[nodiscard]] std::vector<ReportTag> tags_over_time(
    std::span<const TagOnSegment> tags,
    std::span<const CameraDetections> detections,
    const Motion& motion);

}  // namespace marey::app
