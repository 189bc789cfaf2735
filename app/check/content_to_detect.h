// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/board.h"
#include "core/tag_family.h"
#include "recordings/session/session.h"

namespace marey::app {

/// Contents that are detected in the frames of a trial. A board of squares is detected
/// only in trials of the target; tags are detected in all trials, if the session has
/// tags.
struct ContentToDetect {
  std::vector<TagFamilyUse> families;       ///< Empty: no tags.
  std::optional<CalibrationTarget> target;  ///< A board of squares.
  bool shows_grid = false;                  ///< The trial shows an AprilGrid.
  /// The AprilGrid that every camera must see.
  std::optional<AprilGrid> grid;
};

/// Returns the contents to detect in a trial. If the session has one family, all of its
/// tags are detected, since tags that the session does not list show errors in it.
[[nodiscard]] ContentToDetect content_to_detect(const recordings::Session& session,
                                                const recordings::Trial& trial);

}  // namespace marey::app
