// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calib/calibrated_rig.h"
#include "core/board.h"
#include "core/detection.h"
#include "core/result.h"

namespace marey::calib {

/// Calibrates all cameras together from a board waved through the volume and then lying
/// on the floor: intrinsics (5-term Brown-Conrady) and poses by one bundle adjustment.
///
/// World: right-handed, Y up, metres, origin at the board's origin on the floor, X along
/// its x, Z = -(board y).
///
/// `names` per camera, for messages; `waved` and `floor` have one entry per camera, in
/// the same order, and all frames of one index were taken at the same time (floor frames
/// may come from anywhere: nothing moves). Errors (kBadInput): a camera that never sees
/// the board, or too little of it; groups of cameras that never see the board together;
/// no floor; two floor files swapped or a camera moved between the trials; a board that
/// lies face down; a bundle that does not converge or ends with a
/// median corner more than 2.5 px off (wrong board geometry); tags whose size does not go
/// with the gaps between them. Cost: a few seconds for four cameras and a hundred frames.
[[nodiscard]] Result<CalibratedRig> calibrate_cameras(
    std::span<const std::string> names,
    std::span<const CameraDetections> waved,
    std::span<const CameraDetections> floor,
    const AprilGrid& board);

}  // namespace marey::calib
