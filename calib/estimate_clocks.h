// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "calib/calibrated_rig.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/ids.h"

namespace marey::calib {

struct ClockOptions {
  bool solve_drifts = false;
  bool solve_line_delays = false;
  /// Offsets are first looked for up to this, either way, in steps of a frame.
  double most_offset_s = 0.5;
  /// At most so many tags, those that two cameras see most often.
  int most_tags = 40;
};

/// Clocks of known cameras, from whatever tags move before them: each is a rigid body of
/// its own that moves smoothly, and every camera saw it at that camera's own times. Tags
/// of a body's segments, of a wand or of a board will do.
///
/// `detections` one entry per camera, in the order of `cameras`, with their rates and
/// with tag shrinkage taken off; an `offset` that is given is where the search starts.
/// `sizes_m` by tag: others are left out. The first camera's clock is right.
///
/// nullopt when no tag is seen by two cameras often enough (six times) or the solver
/// finds no minimum. A camera that shares no moving tag with others keeps its start, with
/// a sigma of seconds. Cost: some seconds for four cameras and a hundred frames.
/// Precondition: one detections entry per camera; rates and sizes positive.
[[nodiscard]] std::optional<std::vector<SolvedClock>> estimate_clocks(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    const std::map<TagId, double>& sizes_m,
    const ClockOptions& options = {});

}  // namespace marey::calib
