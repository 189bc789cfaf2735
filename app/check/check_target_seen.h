// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Checks that videos show the contents of their trial.

#include <optional>
#include <vector>

#include "app/check/content_to_detect.h"
#include "app/check/match_times.h"
#include "capture/search/detect_videos.h"
#include "core/base/result.h"
#include "core/board.h"
#include "core/detection.h"
#include "core/finding.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Checks for another board than the declared one, before all frames are searched for the
/// declared one. Errors (kBadInput): the first video with another board, with the name of
/// that board.
[[nodiscard]] Status check_board(const recordings::Session& session,
                                 const std::vector<capture::CameraInput>& inputs,
                                 const std::optional<CalibrationTarget>& target);

/// Checks that a camera sees the wanted contents in at least one frame. Errors
/// (kBadInput): no frame shows them; the error names what the video shows instead.
[[nodiscard]] Status check_target_seen(const recordings::Session& session,
                                       const recordings::Trial& trial,
                                       const CameraDetections& camera,
                                       const ContentToDetect& wanted);

/// Checks that at least one camera sees enough of the target on the floor. The floor is
/// computed from the cameras that do; each other camera gives a warning. Errors
/// (kBadInput): no camera sees enough; a video shows the board mirrored, or another
/// board.
[[nodiscard]] Status check_floor_seen(const recordings::Session& session,
                                      const recordings::Trial& trial,
                                      const std::vector<CameraDetections>& found,
                                      const ContentToDetect& wanted,
                                      std::vector<Finding>& findings);

}  // namespace marey::app
