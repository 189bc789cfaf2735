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

/// The tag corners of a trial, and in trials of the target the points of a board of
/// squares; one entry per camera of the session; a camera without a
/// video in the trial has no frames. Taken from OUT/TRIAL/detections where that was made
/// of the same bytes of video by the same detector; what is not there is detected and
/// written there.
///
/// Frames of recorded takes, and of videos with uneven rates, are matched by time
/// (match_times()). A motion goes on without a video that cannot be read, and every trial
/// with a video's part that can be: `troubles` says so.
///
/// Errors: a video of another trial that cannot be read, one that shows not a single tag,
/// or nothing of the board where that is wanted (and what it shows instead), or runs at
/// another rate than its trial's other videos; fewer than two cameras left; the disk.
/// Cost: 10 ms per frame and core of 1280 x 720 where it detects.
[[nodiscard]] Result<std::vector<CameraDetections>> find_tags(
    const recordings::Session& session,
    const recordings::Trial& trial,
    const std::filesystem::path& out,
    Console& console,
    RecordingTroubles& troubles);

/// Whether each camera's pictures are of one size in two trials: it is calibrated for
/// one. Precondition: both per camera of the session.
[[nodiscard]] Status check_picture_sizes(const std::vector<CameraDetections>& earlier,
                                         const std::vector<CameraDetections>& found);

/// Puts the corners of every tag where they would be found without shrinkage.
/// Precondition: detections are of these cameras.
void take_off_shrinkage(std::span<const Camera> cameras,
                        std::vector<CameraDetections>& detections);

}  // namespace marey::app
