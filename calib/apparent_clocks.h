// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: whether cameras that were taken for simultaneous are.

#include <vector>

#include "calib/rig_model.h"

namespace marey::calib {

/// A clock as the residuals of cameras without clocks have it.
struct ApparentClock {
  double offset_s = 0.0;  ///< Against the first camera's.
  double sigma_s = 0.0;   ///< About 1 if no moving tag tells; 0 of the first camera.
};

/// By how much each camera's errors, in a refined model in which frames of one instant
/// are simultaneous, follow the motion of what it sees: one Gauss-Newton step of clock
/// offsets, places of moving targets eliminated. Cameras stay, so that of a motion in one
/// direction they may have taken up a part. Good for a fraction of a frame; beyond that
/// only for telling that something is wrong. Linear in sightings.
/// Precondition: targets have a pose of their own at every instant.
[[nodiscard]] std::vector<ApparentClock> apparent_clocks(const RigModel& model,
                                                         double rate_hz);

/// Whether a clock is off by what would harm a calibration, and surely so.
[[nodiscard]] bool run_apart(const std::vector<ApparentClock>& clocks);

}  // namespace marey::calib
