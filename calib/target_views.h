// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: what a refined model leaves of every sighting, for reports.

#include <vector>

#include "calib/calibrated_rig.h"
#include "calib/rig_model.h"

namespace marey::calib {

/// TargetView of every frame of every camera, ordered by camera, frame and target.
/// Sightings without a place are left out.
[[nodiscard]] std::vector<TargetView> target_views(const RigModel& model);

/// CalibratedRig::shared_views. Views of targets that stay do not count. Where clocks are
/// solved for, views are together when they are less than a knot's spacing apart.
[[nodiscard]] std::vector<int> shared_views(const RigModel& model);

}  // namespace marey::calib
