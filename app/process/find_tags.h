// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "app/shell/console.h"
#include "core/base/result.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/finding.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Detects the tag corners of a trial and, in trials of the calibration target, the
/// points of a board of squares. Returns one entry per camera of the session; a camera
/// without a video in the trial has no frames. Detections are read from
/// OUT/TRIAL/detections if they were made from the same bytes of video by the same
/// detector. Others are computed and written there.
///
/// Frames of recorded takes, and of videos with uneven rates, are matched by time
/// (match_times()). A motion is processed without a video that cannot be read, and every
/// trial with the readable part of a video; both are poor findings.
///
/// Errors: a video that cannot be read in a trial that is not a motion; a video without
/// any tag, or without the board where the board is required (the error names what the
/// video shows instead); a video with another rate than the trial's other videos; fewer
/// than two cameras left; a failure of the disk. Cost: 10 ms per frame and core at 1280 x
/// 720, if the frame is not in the cache.
[[nodiscard]] Result<std::vector<CameraDetections>> find_tags(
    const recordings::Session& session,
    const recordings::Trial& trial,
    const std::filesystem::path& out,
    Console& console,
    std::vector<Finding>& findings);

/// Moves the corners of every tag to where they would be detected without shrinkage.
/// Precondition: the detections are of these cameras.
void correct_shrinkage(std::span<const Camera> cameras,
                       std::vector<CameraDetections>& detections);

}  // namespace marey::app
