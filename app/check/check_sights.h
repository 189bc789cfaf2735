// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Whether videos show what their trial is about.

#include <optional>
#include <vector>

#include "app/check/match_times.h"
#include "capture/search/detect_videos.h"
#include "core/base/result.h"
#include "core/board.h"
#include "core/detection.h"
#include "recordings/session/session.h"

namespace marey::app {

/// What a trial's frames are searched for. A board of squares is in the trials that are
/// about it; tags are everywhere, when there are any.
struct Wanted {
  std::vector<TagFamilyUse> families;       ///< Empty: no tags.
  std::optional<CalibrationTarget> target;  ///< Of squares: its points.
  bool shows_grid = false;                  ///< The trial is about an AprilGrid.
  /// The AprilGrid that every camera must see.
  std::optional<AprilGrid> grid;
};

/// Before all frames are searched for what is not there: another board that was filmed.
[[nodiscard]] Status check_board(const recordings::Session& session,
                                 const std::vector<capture::CameraInput>& inputs,
                                 const std::optional<CalibrationTarget>& target);

/// Errors: nothing of what is wanted is in any frame of the camera, and what is instead.
[[nodiscard]] Status check_seen(const recordings::Session& session,
                                const recordings::Trial& trial,
                                const CameraDetections& camera,
                                const Wanted& wanted);

/// The floor is known by the cameras that see enough of it: of the others a warning says
/// so. Errors: no camera does; a video that shows the board mirrored, or another one.
[[nodiscard]] Status check_floor_seen(const recordings::Session& session,
                                      const recordings::Trial& trial,
                                      const std::vector<CameraDetections>& found,
                                      const Wanted& wanted,
                                      RecordingTroubles& troubles);

}  // namespace marey::app
