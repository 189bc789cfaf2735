// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "calib/model/calibrated_rig.h"
#include "core/base/ids.h"
#include "core/camera.h"
#include "core/detection.h"

namespace marey::calib {

struct ClockOptions {
  bool solve_drifts = false;
  bool solve_line_delays = false;
  /// Range of the first search of offsets in both directions, in steps of a frame.
  double max_offset_s = 0.5;
  /// Upper limit of the number of tags. Tags that two cameras see most often are used.
  int max_tags = 40;
};

/// Estimates the clocks of known cameras from the tags that move in view: each tag is a
/// separate rigid body with a smooth motion, and each camera saw it at that camera's own
/// times. Tags on body segments, on a wand or on a board are all usable.
///
/// `detections` has one entry per camera, in the order of `cameras`, with rates and with
/// tag shrinkage corrected; a given `offset` is the start of the search. `sizes_m` is by
/// tag; tags without a size are ignored. The first camera's clock is the reference.
///
/// Returns nullopt if no tag is seen by two cameras often enough (six times) or the
/// solver finds no minimum. A camera that shares no moving tag with others keeps its
/// start value, with a sigma of seconds. Cost: some seconds for four cameras and a
/// hundred frames.
/// Preconditions: one detections entry per camera; rates and sizes are positive.
[[nodiscard]] std::optional<std::vector<SolvedClock>> estimate_clocks(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    const std::map<TagId, double>& sizes_m,
    const ClockOptions& options = {});

}  // namespace marey::calib
