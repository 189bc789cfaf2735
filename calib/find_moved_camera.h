// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>

#include "calib/calibrated_rig.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/ids.h"

namespace marey::calib {

/// Tests, for each camera, whether it stands where its calibration says, by the corners
/// of tags that two or more cameras see at once. A tag may move as it likes from frame to
/// frame; clocks may be one and a half frames apart, and are solved for (given offsets
/// are ignored), once more without the suspect's. Needs no body.
///
/// Returns the move (one rotation and translation of one camera from one frame on) that
/// explains most of what is left, however small it is: ApparentMove with `from_frame`
/// nullopt where it holds for the whole trial, or no start within it is certain. Returns
/// nullopt if fewer than 30 tags were seen by two cameras at once.
///
/// `detections` one entry per camera, in the order of `cameras`, with their rates and tag
/// shrinkage taken off; `sizes_m` by tag: others are left out. Cost: a second or two.
[[nodiscard]] std::optional<ApparentMove> find_moved_camera(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    const std::map<TagId, double>& sizes_m);

}  // namespace marey::calib
