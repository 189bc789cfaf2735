// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: chooses the lens model, and whether clocks are solved for.

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "calib/bundle/refine_rig.h"
#include "calib/model/rig_model.h"
#include "core/base/result.h"
#include "core/camera.h"
#include "core/detection.h"

namespace marey::calib {

/// Cameras after bundle adjustment, before any check.
struct SolvedRig {
  RigModel model;
  RefineOptions refine;
  /// nullopt: the solver found no minimum.
  std::optional<RigUncertainty> uncertainty;
};

/// Returns an unrefined rig with the given lens (`uncertainty` is empty), or an error.
using FirstModel = std::function<Result<SolvedRig>(LensModel)>;

/// Returns the lens model with the lowest error on held-out frames. A simpler model is
/// kept unless a larger one is clearly better (predicts_better()). Order: five terms,
/// four of the fisheye, eight.
[[nodiscard]] LensModel choose_lens(const FirstModel& first_model);

/// Clock parameters that are solved for.
struct Clocks {
  bool offsets = false;
  bool drifts = false;
  bool line_delays = false;
};

/// Solves with clocks if the pictures show that they are needed: the cameras have several
/// rates; their errors follow the motion of the target; or the fit on one clock is poor
/// (many sightings of a camera are outliers) and clearly better with clocks.
/// `clocks_may_unplace`: unconnected cameras may be caused by their clocks and are not
/// yet an error. `line_delays`: solve for line delays after the choice of clocks.
[[nodiscard]] Result<SolvedRig> solve_choosing_clocks(
    std::span<const std::string> names,
    std::span<const CameraDetections> waved,
    bool clocks_may_unplace,
    bool line_delays,
    const std::function<Result<SolvedRig>(const Clocks&)>& solve);

}  // namespace marey::calib
