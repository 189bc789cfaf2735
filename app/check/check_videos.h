// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/check/match_times.h"
#include "core/base/result.h"
#include "core/finding.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Checks the headers of the videos of all trials, before any video is decoded.
///
/// Errors (kBadInput):
/// - a video that cannot be opened, in a trial that is not a motion, or in a motion in
///   which fewer than two videos can be opened;
/// - a range of frames of the trial that is longer than one of its videos;
/// - a folder of images with gaps in their numbers;
/// - a picture size or a rotation mark that differs from an earlier trial of the camera;
/// - a missing table of times.
///
/// The second and third do not apply to trials whose frames are matched by time. In a
/// motion, a video that cannot be opened is a warning, and the motion is processed
/// without it. check_files() reports missing videos. Cost: a few tens of milliseconds per
/// video and core.
[[nodiscard]] Status check_videos(const recordings::Session& session,
                                  std::vector<Finding>& findings);

/// Appends a fair finding for each video that ends before others of its trial, by more
/// than 0.5 s and 5 % of the longest. `found` has one entry per camera of the session,
/// with all frames. Videos that could not be read to the end are reported by find_tags().
/// Calibration trials are not checked: their videos may begin and end at any time.
void assess_video_lengths(const recordings::Session& session,
                          const recordings::Trial& trial,
                          const std::vector<CameraDetections>& found,
                          std::vector<Finding>& findings);

}  // namespace marey::app
