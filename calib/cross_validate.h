// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: models judged by what they did not see.

#include <optional>

#include "calib/calibrated_rig.h"
#include "calib/refine_rig.h"
#include "calib/rig_model.h"
#include "calib/steps.h"

namespace marey::calib {

/// The model's sightings of frames whose number is even (0) or odd (1); what stays is in
/// both.
[[nodiscard]] RigModel half_of(const RigModel& model, int parity);

/// `held_out` as the cameras of `solved` have it: targets find their places, cameras
/// stay. nullopt where they do not.
[[nodiscard]] std::optional<RigModel> held_out_model(const RigModel& solved,
                                                     const RigModel& held_out);

/// Whether errors in frames that neither saw (held_out_model()) are clearly smaller than
/// those of a model of fewer terms: by three percent, and by more than twice what chance
/// makes of the frames' differences. Outliers left out.
[[nodiscard]] bool predicts_better(const RigModel& model, const RigModel& simpler);

/// The model's sightings of the first (0) or second (1) half of its frames; what stays is
/// in both.
[[nodiscard]] RigModel half_in_time(const RigModel& model, int half);

/// Enlarges the covariance and the sigmas of cameras whose halves in time disagree by
/// more than twice what is expected, by that ratio.
void widen_by_halves(CalibratedRig& rig);

/// Refines both halves of a refined model anew, and leaves out each camera in turn.
/// nullopt where a half says too little or its bundle does not converge. Takes five
/// steps and one for each camera.
[[nodiscard]] std::optional<CrossValidation> cross_validate(const RigModel& model,
                                                            const RefineOptions& options,
                                                            Steps& steps);

/// Whether the board is bent: halves of the recording, refined with a warp of the boards'
/// own, agree on it to a half of its size, and it is a tenth of a millimetre or more
/// somewhere. The board is then bent in `model` (which is not refined).
[[nodiscard]] bool find_warp(RigModel& model, const RefineOptions& options);

}  // namespace marey::calib
