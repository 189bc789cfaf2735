// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/detection.h"
#include "core/ids.h"

namespace marey::calib {

/// The clock of a camera relative to the first camera's: frame k was exposed at
/// k / rate + offset_s on the first camera's clock.
struct ClockOffset {
  double offset_s = 0.0;
  double sigma_s = 1.0;  ///< About 1 if no moving tag tells; 0 of the first camera.
};

/// Finds clock offsets between calibrated cameras from the tags of one trial that two or
/// more of them see at once and that move, each by itself: no body is needed. Searches
/// about the offsets that the detections carry (zero where they carry none), for one and a
/// half frames: larger offsets are detected, their value is unreliable. Good to a
/// millisecond where tags move by 1 m/s.
///
/// `detections` one entry per camera, in the order of `cameras`, tag shrinkage taken off;
/// `sizes_m` by tag: others are left out. Returns one entry per camera; the first is zero.
/// Precondition: at least one camera. Cost: a second or two.
[[nodiscard]] std::vector<ClockOffset> find_clock_offsets(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    const std::map<TagId, double>& sizes_m);

}  // namespace marey::calib
