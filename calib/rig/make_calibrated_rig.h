// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: converts a refined model to the public CalibratedRig.

#include <span>
#include <string>

#include "calib/bundle/refine_rig.h"
#include "calib/model/calibrated_rig.h"
#include "calib/model/rig_model.h"

namespace marey::calib {

/// Returns cameras, errors over all sightings (including outliers), coverage and sigmas
/// in the world of the model. Sightings without a pose are ignored. Static tags count for
/// the errors of the rig, not for the quality of a camera.
[[nodiscard]] CalibratedRig make_calibrated_rig(std::span<const std::string> names,
                                                const RigModel& model,
                                                const RigUncertainty& uncertainty);

/// Rotates the covariance into the new world.
void turn_covariance(const glm::dquat& new_from_old, RigCovariance& covariance);

/// Transforms the model to a new world: applies `new_from_world` to cameras, targets and
/// the covariance.
void move_model(const RigidTransform& new_from_world,
                RigModel& model,
                RigUncertainty& uncertainty);

}  // namespace marey::calib
