// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/calibrated_rig.h"
#include "core/board.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/progress.h"
#include "core/result.h"

namespace marey::calib {

struct CalibrateOptions {
  LensModel lens = LensModel::kBrownConrady;
  /// Instead of `lens`, the one that does best on odd frames after seeing the even ones.
  /// Of cameras whose lenses are not given; costs nothing when all are.
  bool choose_lens = false;
  /// Per camera: its lens, when it is known already; it is held. Empty: none is known.
  std::vector<std::optional<Intrinsics>> lenses{};
  /// Cameras started on their own: their clocks' offsets against the first camera's are
  /// found from the board's motion, and perhaps by how much they drift, and how long a
  /// sensor takes from one row to the next. Need rates above zero of the detections.
  bool solve_offsets = false;
  bool solve_drifts = false;
  bool solve_line_delays = false;
  /// Instead of solve_offsets and solve_drifts: they are solved for when the cameras turn
  /// out not to run on one clock. Cameras of different rates never do. Needs rates too.
  bool choose_clocks = false;
  double most_offset_s = 5.0;  ///< Offsets are looked for up to this, either way.
  /// Asks whether the board is bent (CalibratedRig::warp_m): twice the time.
  bool find_warp = false;
  /// Fills CalibratedRig::cross_validation: some times the time.
  bool cross_validate = false;
  /// Called as parts of the work are done.
  Progress progress{};
};

/// Calibrates all cameras together from a board waved through the volume and then lying
/// on the floor: intrinsics and poses, and what the options ask for, by one bundle
/// adjustment.
///
/// World: right-handed, Y up, metres, origin at the board's origin on the floor, X along
/// its x, Z = -(board y). Without any floor detections, the first camera's place is the
/// origin, its right X, its up Y.
///
/// `names` per camera, for messages; `waved` and `floor` have one entry per camera, in
/// the same order (`floor` may be empty), and all frames of one index were taken at the
/// same time unless offsets are solved for (floor frames may come from anywhere: nothing
/// moves). A clock that was solved for has a sigma above zero (CalibratedRig::clocks).
/// Errors (kBadInput): a camera that never sees the board, or too little of it; groups of
/// cameras that never see the board together; no board in the floor detections; two floor
/// files swapped or a camera moved between the trials; a board that lies face down, or is
/// mirrored; a bundle that does not converge or ends with a median corner more than 2.5
/// px off (wrong board geometry); tags whose size does not go with the gaps between them.
/// Cost: a few seconds for four cameras and a hundred frames. Precondition: the board is
/// no wand (calibrate_wand()); lenses that are given are of pictures of the cameras'
/// sizes; rates are above zero where clocks are solved for or chosen.
[[nodiscard]] Result<CalibratedRig> calibrate_cameras(
    std::span<const std::string> names,
    std::span<const CameraDetections> waved,
    std::span<const CameraDetections> floor,
    const CalibrationTarget& board,
    const CalibrateOptions& options = {});

}  // namespace marey::calib
