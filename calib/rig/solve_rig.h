// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: the steps that calibrations from a board and from a wand share.

#include <functional>
#include <span>
#include <string>

#include "calib/model/calibrated_rig.h"
#include "calib/model/calibration_steps.h"
#include "calib/model/rig_options.h"
#include "calib/rig/choose_model.h"

namespace marey::calib {

/// Returns the rig that is solved for with these clocks. The other options are those of
/// the calibration.
using SolveWithClocks = std::function<Result<SolvedRig>(const Clocks&)>;

/// Solves with the clocks of `options`; if they are to be chosen, calls
/// solve_choosing_clocks(). Takes kSolveSteps steps.
[[nodiscard]] Result<SolvedRig> solve_rig(std::span<const std::string> names,
                                          std::span<const CameraDetections> waved,
                                          bool clocks_may_unplace,
                                          const RigOptions& options,
                                          const SolveWithClocks& solve,
                                          Steps& steps);

/// Sets the refinement's clocks and held lenses from the options of a calibration of that
/// many cameras.
void set_unknowns(const RigOptions& options, std::size_t cameras, RefineOptions& refine);

/// Fills in the tests for recording faults and the cross-validation of `rig`, and
/// finishes the steps.
void validate_rig(const SolvedRig& solved,
                  const RigOptions& options,
                  double rate_hz,
                  Steps& steps,
                  CalibratedRig& rig);

}  // namespace marey::calib
