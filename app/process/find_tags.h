// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "app/check/match_times.h"
#include "app/shell/console.h"
#include "core/base/result.h"
#include "core/camera.h"
#include "core/detection.h"
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
/// trial with the readable part of a video; `troubles` lists both.
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
    RecordingTroubles& troubles);

/// Checks that each camera has the same picture size in two trials, as it is calibrated
/// for one size. Errors (kBadInput): the first camera with two sizes. Precondition: both
/// arguments have one entry per camera of the session.
[[nodiscard]] Status check_picture_sizes(const std::vector<CameraDetections>& earlier,
                                         const std::vector<CameraDetections>& found);

/// Moves the corners of every tag to where they would be detected without shrinkage.
/// Precondition: the detections are of these cameras.
void take_off_shrinkage(std::span<const Camera> cameras,
                        std::vector<CameraDetections>& detections);

}  // namespace marey::app
