// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "calib/model/calibrated_rig.h"
#include "calib/model/rig_options.h"
#include "core/base/result.h"
#include "core/board.h"
#include "core/detection.h"

namespace marey::calib {

/// Options of calibrate_cameras(). The choice of lenses is free if all are given.
struct CalibrateOptions : RigOptions {
  /// Tests whether the board is bent (CalibratedRig::warp_m); doubles the time.
  bool find_warp = false;
};

/// Calibrates all cameras together from a board that is waved through the volume and then
/// lies on the floor. One bundle adjustment computes intrinsics and poses, and the
/// quantities that the options select.
///
/// World: right-handed, Y up, metres, origin at the board's origin on the floor, X along
/// its x, Z = -(board y). Without any floor detections, the origin is the first camera's
/// centre, X its right, Y its up.
///
/// `names` per camera, for messages. `waved` and `floor` have one entry per camera, in
/// the same order; `floor` may be empty. All frames of one index were taken at the same
/// time, unless offsets are solved for. Floor frames need no common time, as nothing
/// moves in them. A clock that was solved for has a sigma above zero
/// (CalibratedRig::clocks).
/// Errors (kBadInput): a camera that never sees the board, or sees too little of it;
/// groups of cameras that never see the board together; no board in the floor detections;
/// two floor files exchanged or a camera moved between the trials; a board that lies face
/// down or is mirrored; a bundle that does not converge or ends with a median corner
/// error above 2.5 px (wrong board geometry); tags whose size does not match the gaps
/// between them.
/// Cost: a few seconds for four cameras and a hundred frames. Preconditions: the board is
/// not a wand (calibrate_wand()); given lenses match the image sizes of their cameras;
/// rates are above zero if clocks are solved for or chosen.
[[nodiscard]] Result<CalibratedRig> calibrate_cameras(
    std::span<const std::string> names,
    std::span<const CameraDetections> waved,
    std::span<const CameraDetections> floor,
    const CalibrationTarget& board,
    const CalibrateOptions& options = {});

}  // namespace marey::calib
