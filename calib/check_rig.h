// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: what a recording of a board got wrong, in words.

#include <span>

#include "calib/board_views.h"
#include "calib/calibrated_rig.h"
#include "core/board.h"
#include "core/detection.h"
#include "core/result.h"

namespace marey::calib {

/// Why one camera's views of the board tell no lens.
[[nodiscard]] Error too_few_views(const CameraDetections& camera,
                                  const CalibrationTarget& board);

/// Errors of a board that its cameras see from behind: its points run the other way than
/// they were said to. Cameras know their lenses by now.
[[nodiscard]] Status check_mirrored(std::span<const BoardView> views,
                                    std::span<const Intrinsics> intrinsics);

/// Its median corner is too far off for any calibration.
[[nodiscard]] bool is_hopeless(const CalibratedRig& rig);

/// Whether the refined rig is one: errors of hopeless corners, of a board whose squares
/// do not go with their gaps, of a floor that disagrees or is seen from below, or of a
/// camera of which that is so because its pictures are of other times than the others'.
[[nodiscard]] Status check_rig(const CalibratedRig& rig,
                               std::span<const BoardView> views,
                               std::span<const CameraDetections> waved,
                               std::span<const CameraDetections> floor,
                               const CalibrationTarget& board);

}  // namespace marey::calib
