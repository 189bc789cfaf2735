// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: residuals of a refined model, for reports.

#include <vector>

#include "calib/model/calibrated_rig.h"
#include "calib/model/rig_model.h"

namespace marey::calib {

/// Returns the TargetView of every frame of every camera, ordered by camera, frame and
/// target. Sightings without a pose are omitted.
[[nodiscard]] std::vector<TargetView> target_views(const RigModel& model);

/// Returns CalibratedRig::shared_views. Views of static targets do not count. If clocks
/// are solved for, views are shared if they are less than a knot's spacing apart.
[[nodiscard]] std::vector<int> shared_views(const RigModel& model);

}  // namespace marey::calib
