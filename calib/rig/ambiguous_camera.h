// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: cameras with an ambiguous pose.

#include <optional>

#include "calib/model/calibrated_rig.h"
#include "calib/model/rig_model.h"

namespace marey::calib {

/// Tests cameras for planar pose ambiguity: a distant flat board has two pose solutions.
/// Considers each camera that shares at most eight instants with the others. A camera is
/// ambiguous if the other solution of a shared view places it elsewhere and explains all
/// its shared views equally well. Returns nullopt if no camera is ambiguous. Cost:
/// milliseconds for each such camera.
[[nodiscard]] std::optional<AmbiguousCamera> ambiguous_camera(const RigModel& model);

}  // namespace marey::calib
