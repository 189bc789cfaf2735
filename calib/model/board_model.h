// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: conversion of board views to a RigModel.

#include <span>
#include <vector>

#include "calib/model/board_views.h"
#include "calib/model/place_cameras.h"
#include "calib/model/rig_model.h"
#include "core/board.h"
#include "core/detection.h"

namespace marey::calib {

/// Builds a model in which frames of one number are simultaneous: the board has a
/// separate pose in each. Views of the floor belong to a static board.
[[nodiscard]] RigModel still_model(std::span<const BoardView> views,
                                   std::span<const Intrinsics> intrinsics,
                                   const RigGuess& guess,
                                   const CalibrationTarget& board);

/// Builds a model in which cameras have their own clocks. The board's path is a cubic
/// B-spline of poses (calib/model/spline_pose.h). Its control poses, the knots, are one
/// frame of the fastest camera apart, but at least 1/60 s. A new path begins after a jump
/// or a period without views. `offsets_s` per camera, as in SolvedClock.
[[nodiscard]] RigModel moving_model(std::span<const BoardView> views,
                                    std::span<const Intrinsics> intrinsics,
                                    const RigGuess& guess,
                                    const CalibrationTarget& board,
                                    std::span<const CameraDetections> waved,
                                    std::span<const double> offsets_s);

/// A pose at a time.
struct TimedPose {
  double time_s = 0.0;
  RigidTransform world_from_target;
};

/// Splits a motion at jumps and pauses. Returns the time of the first pose of each part.
/// Precondition: ascending times.
[[nodiscard]] std::vector<double> parts_of_motion(std::span<const TimedPose> poses,
                                                  double spacing_s);

/// Returns the initial knots of a path: knot k is the pose at k * spacing_s, interpolated
/// between the neighbouring poses, and constant before the first and after the last. The
/// numbers extend beyond the poses as far as the spline needs them. Preconditions:
/// ascending times, not empty; spacing above 0.
[[nodiscard]] std::map<int, RigidTransform> knots_through(
    std::span<const TimedPose> poses, double spacing_s);

}  // namespace marey::calib
