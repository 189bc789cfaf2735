// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: views of a board as a RigModel.

#include <span>
#include <vector>

#include "calib/board_views.h"
#include "calib/place_cameras.h"
#include "calib/rig_model.h"
#include "core/board.h"
#include "core/detection.h"

namespace marey::calib {

/// Frames of one number are simultaneous: the board has a place of its own in each. Views
/// of the floor are of a board that stays.
[[nodiscard]] RigModel still_model(std::span<const BoardView> views,
                                   std::span<const Intrinsics> intrinsics,
                                   const RigGuess& guess,
                                   const CalibrationTarget& board);

/// Cameras run on their own clocks, and the board moves smoothly between knots half a
/// frame (of the fastest camera, at least 1/60 s) to a frame apart. Where it jumps, or
/// nobody sees it for a while, another motion begins. `offsets_s` per camera, as
/// SolvedClock's.
[[nodiscard]] RigModel moving_model(std::span<const BoardView> views,
                                    std::span<const Intrinsics> intrinsics,
                                    const RigGuess& guess,
                                    const CalibrationTarget& board,
                                    std::span<const CameraDetections> waved,
                                    std::span<const double> offsets_s);

/// A pose met at a time.
struct TimedPose {
  double time_s = 0.0;
  RigidTransform world_from_target;
};

/// Cuts a motion where it jumps or pauses: the time of the first pose of each part.
/// Precondition: ascending times.
[[nodiscard]] std::vector<double> parts_of_motion(std::span<const TimedPose> poses,
                                                  double spacing_s);

/// Knots, by number, through poses near them. Precondition: ascending times, not empty.
[[nodiscard]] std::map<int, RigidTransform> knots_through(
    std::span<const TimedPose> poses, double spacing_s);

}  // namespace marey::calib
