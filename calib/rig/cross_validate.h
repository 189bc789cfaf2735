// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: validation of models on held-out data.

#include <optional>

#include "calib/bundle/refine_rig.h"
#include "calib/model/calibrated_rig.h"
#include "calib/model/calibration_steps.h"
#include "calib/model/rig_model.h"

namespace marey::calib {

/// Returns the model's sightings of frames with an even (0) or odd (1) number. Targets
/// that do not move are in both halves.
[[nodiscard]] RigModel half_of(const RigModel& model, int parity);

/// Returns `held_out` with the cameras of `solved`: cameras are held, poses of targets
/// are solved for. Returns nullopt if these are not found.
[[nodiscard]] std::optional<RigModel> held_out_model(const RigModel& solved,
                                                     const RigModel& held_out);

/// Returns true if the errors in held-out frames (held_out_model()) are clearly smaller
/// than those of a model with fewer terms: by at least three percent, and by more than
/// twice the standard error of the difference over frames. Outliers are excluded.
[[nodiscard]] bool predicts_better(const RigModel& model, const RigModel& simpler);

/// Returns the model's sightings of the first (0) or second (1) half of its frames.
/// Targets that do not move are in both halves.
[[nodiscard]] RigModel half_in_time(const RigModel& model, int half);

/// Scales the covariance and the sigmas of cameras whose halves in time differ by more
/// than twice the expectation; the factor is that ratio.
void widen_by_halves(CalibratedRig& rig);

/// Refines both halves of a refined model again, and excludes each camera in turn.
/// Returns nullopt if a half has too few data or its bundle does not converge. Takes five
/// steps, and one for each camera.
[[nodiscard]] std::optional<CrossValidation> cross_validate(const RigModel& model,
                                                            const RefineOptions& options,
                                                            Steps& steps);

/// Tests whether the board is bent: the halves of the recording, each refined with its
/// own warp of the boards, agree to half of the warp's size, and the warp is at least a
/// tenth of a millimetre somewhere. If so, sets `bends` in `model`, which is not refined.
[[nodiscard]] bool find_warp(RigModel& model, const RefineOptions& options);

}  // namespace marey::calib
