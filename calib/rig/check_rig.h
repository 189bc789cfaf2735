// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: error messages for faults in a recording of a board.

#include <span>

#include "calib/model/board_views.h"
#include "calib/model/calibrated_rig.h"
#include "core/base/result.h"
#include "core/board.h"
#include "core/detection.h"

namespace marey::calib {

/// Returns the reason why one camera's views of the board do not determine its lens.
[[nodiscard]] Error too_few_views(const CameraDetections& camera,
                                  const CalibrationTarget& board);

/// Returns an error if the cameras see the board from behind: its points then run in the
/// opposite direction to the declared one. Precondition: the cameras' lenses are
/// estimated.
[[nodiscard]] Status check_mirrored(std::span<const BoardView> views,
                                    std::span<const Intrinsics> intrinsics);

/// Returns true if the median corner error is too large for any calibration.
[[nodiscard]] bool is_unusable(const CalibratedRig& rig);

/// Checks the refined rig. Errors: a median corner error that is too large; a board whose
/// squares do not match its gaps; floor views that disagree or see the board from below.
/// These are reported for a single camera if its pictures were taken at other times than
/// the others' pictures.
[[nodiscard]] Status check_rig(const CalibratedRig& rig,
                               std::span<const BoardView> views,
                               std::span<const CameraDetections> waved,
                               std::span<const CameraDetections> floor,
                               const CalibrationTarget& board);

}  // namespace marey::calib
