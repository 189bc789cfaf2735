// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/base/progress.h"
#include "core/camera.h"

namespace marey::calib {

/// Options of a calibration from a board or from a wand.
struct RigOptions {
  LensModel lens = LensModel::kBrownConrady;
  /// Replaces `lens` by the model with the lowest error on odd frames after a fit to the
  /// even frames. Applies to cameras without a given lens.
  bool choose_lens = false;
  /// Per camera: its lens if it is already known; it is held fixed. Empty: none is known.
  std::vector<std::optional<Intrinsics>> lenses{};
  /// For cameras that were started separately: estimate the clock offsets relative to the
  /// first camera from the target's motion, and optionally the drifts and the delay from
  /// one sensor row to the next. Needs detections with rates above zero.
  bool solve_offsets = false;
  bool solve_drifts = false;
  bool solve_line_delays = false;
  /// Replaces solve_offsets and solve_drifts: both are solved for if the cameras turn out
  /// not to share one clock. Cameras with different rates never share one. Needs rates
  /// too.
  bool choose_clocks = false;
  double max_offset_s = 5.0;  ///< Search range of the offsets, in both directions.
  /// Fills CalibratedRig::cross_validation; multiplies the time.
  bool cross_validate = false;
  /// Called as parts of the work finish.
  Progress progress{};

  /// Returns true if the lens of this camera is given.
  [[nodiscard]] bool has_lens(std::size_t camera) const {
    return camera < lenses.size() && lenses[camera].has_value();
  }
  /// Returns true if the target moves between the pictures of one index.
  [[nodiscard]] bool solves_clocks() const {
    return solve_offsets || solve_drifts || solve_line_delays;
  }
};

}  // namespace marey::calib
