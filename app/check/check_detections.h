// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Checks of a trial's detections before their use.

#include <vector>

#include "app/check/content_to_detect.h"
#include "core/base/result.h"
#include "core/detection.h"
#include "core/finding.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Checks that the video of a recorded trial exists. Error (kBadInput): it does not.
[[nodiscard]] Status check_video_exists(const recordings::Session& session,
                                        const recordings::Trial& trial,
                                        const recordings::TrialVideo& video);

/// Checks that enough videos could be read: two of a motion, all of other trials.
/// Appends a poor finding for each video that could not be read to the end, and a fair
/// one for damaged frames. Errors: that of the last video that could not be read;
/// `findings` may already have those of missing videos.
[[nodiscard]] Status check_readable(const recordings::Trial& trial,
                                    const std::vector<CameraDetections>& found,
                                    std::vector<Finding>& findings);

/// Checks that every camera sees the wanted contents, and that its offset is at most two
/// frames, as offsets are corrected as motion between frames, not by skipping frames. In
/// a floor trial one camera that sees the target is enough; the others are fair findings.
/// Errors: kBadInput.
[[nodiscard]] Status check_content(const recordings::Session& session,
                                   const recordings::Trial& trial,
                                   const std::vector<CameraDetections>& found,
                                   const ContentToDetect& wanted,
                                   std::vector<Finding>& findings);

/// Checks that all videos of a trial have one rate, as frames are matched by number.
/// Passes for a calibration trial whose clocks are estimated. Sets this rate for cameras
/// without a video in the trial. Precondition: at least one camera has frames.
[[nodiscard]] Status check_rates(const recordings::Session& session,
                                 const recordings::Trial& trial,
                                 std::vector<CameraDetections>& cameras);

/// Checks that each camera has the same picture size in two trials, as it is calibrated
/// for one size. Errors (kBadInput): the first camera with two sizes. Precondition: both
/// arguments have one entry per camera of the session.
[[nodiscard]] Status check_picture_sizes(const std::vector<CameraDetections>& earlier,
                                         const std::vector<CameraDetections>& found);

}  // namespace marey::app
