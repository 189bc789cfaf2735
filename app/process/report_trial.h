// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "app/pages/report.h"
#include "core/base/result.h"
#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"
#include "reconstruct/tags/solve_motion.h"
#include "recordings/session/session.h"

namespace marey::app {

/// What the report says of one solved trial: its figures per camera and frame, tags over
/// time, gaps, pictures of a few frames, and the subject in motion. `detections` are per
/// camera, as the solver saw them. Errors: a video cannot be read any more.
[[nodiscard]] Result<ReportTrial> report_trial(
    const recordings::Trial& trial,
    std::span<const Camera> cameras,
    std::span<const TagOnSegment> tags,
    std::span<const CameraDetections> detections,
    const reconstruct::SolvedTrial& solved);

}  // namespace marey::app
