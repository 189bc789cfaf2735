// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: a refined model as others see it.

#include <span>
#include <string>

#include "calib/calibrated_rig.h"
#include "calib/refine_rig.h"
#include "calib/rig_model.h"

namespace marey::calib {

/// Cameras, errors over all sightings (outliers too), coverage and sigmas. The world
/// stays as it is in the model. Sightings that have no place count for nothing; scenery
/// counts for the rig as a whole, and not for the quality of a camera.
[[nodiscard]] CalibratedRig judge_rig(std::span<const std::string> names,
                                      const RigModel& model,
                                      const RigDoubt& doubt);

/// The covariance in a world turned by that.
void turn_covariance(const glm::dquat& new_from_old, RigCovariance& covariance);

/// Moves the model's world: `new_from_world` for cameras, targets, and the covariance.
void move_world(const RigidTransform& new_from_world, RigModel& model, RigDoubt& doubt);

}  // namespace marey::calib
