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

/// Returns the part of the report about one solved trial: figures per camera and frame,
/// tags over time, gaps, pictures of a few frames, and the motion of the subject.
/// `detections` has one entry per camera, as given to the solver. Errors: a video can no
/// longer be read.
[[nodiscard]] Result<ReportTrial> report_trial(
    const recordings::Trial& trial,
    std::span<const Camera> cameras,
    std::span<const TagOnSegment> tags,
    std::span<const CameraDetections> detections,
    const reconstruct::SolvedTrial& solved);

}  // namespace marey::app
