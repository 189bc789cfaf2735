// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/camera.h"
#include "core/detection.h"

namespace marey::calib {

/// The clock of a camera relative to the first camera's: frame k was exposed at k / rate
/// + offset_s on the first camera's clock.
struct ClockOffset {
  double offset_s = 0.0;
  double sigma_s = 1.0;  ///< About 1 without a moving tag; 0 for the first camera.
};

/// Estimates clock offsets between calibrated cameras from the moving tags of one trial
/// that two or more cameras see at once. Each tag is used independently: no body is
/// needed. Searches around the offsets of the detections (zero if they have none), up to
/// one and a half frames. Larger offsets are detected, but their value is unreliable.
/// Accurate to a millisecond if tags move at 1 m/s.
///
/// `detections` has one entry per camera, in the order of `cameras`, with tag shrinkage
/// corrected. `sizes_m` is by tag; tags without a size are ignored. Returns one entry per
/// camera; the first is zero. Precondition: at least one camera. Cost: a second or two.
[[nodiscard]] std::vector<ClockOffset> find_clock_offsets(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    const std::map<TagId, double>& sizes_m);

}  // namespace marey::calib
