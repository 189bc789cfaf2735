// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>

#include "calib/model/calibrated_rig.h"
#include "core/base/ids.h"
#include "core/camera.h"
#include "core/detection.h"

namespace marey::calib {

/// Tests, for each camera, whether its pose is that of its calibration, from the corners
/// of tags that two or more cameras see at once. Tags may move freely from frame to
/// frame. Clocks may differ by one and a half frames and are solved for (given offsets
/// are ignored), a second time without the suspected camera. Needs no body.
///
/// Returns the move (one rotation and translation of one camera from one frame on) that
/// explains most of the remaining error, however small it is. ApparentMove::from_frame is
/// nullopt if the move holds for the whole trial or no start within it is significant.
/// Returns nullopt if fewer than 30 tags were seen by two cameras at once.
///
/// `detections` has one entry per camera, in the order of `cameras`, with rates and with
/// tag shrinkage corrected. `sizes_m` is by tag; tags without a size are ignored. Cost: a
/// second or two.
[[nodiscard]] std::optional<ApparentMove> find_moved_camera(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    const std::map<TagId, double>& sizes_m);

}  // namespace marey::calib
