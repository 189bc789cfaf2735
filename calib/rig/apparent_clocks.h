// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: tests whether cameras that were assumed simultaneous are.

#include <vector>

#include "calib/model/rig_model.h"

namespace marey::calib {

/// Clock offset of a camera, estimated from the residuals of a rig without clocks.
struct ApparentClock {
  double offset_s = 0.0;  ///< Relative to the first camera's clock.
  double sigma_s = 0.0;   ///< About 1 without a moving tag; 0 for the first camera.
};

/// Computes the clock offset of each camera from the residuals of a refined model in
/// which frames of one instant are simultaneous: one Gauss-Newton step of the offsets,
/// with the poses of moving targets eliminated. Cameras are held; a motion in a single
/// direction may therefore be partly absorbed in their poses. Accurate for offsets below
/// one frame; larger offsets are detected, but their values are unreliable. Linear in
/// sightings.
/// Precondition: targets have a separate pose at every instant.
[[nodiscard]] std::vector<ApparentClock> apparent_clocks(const RigModel& model,
                                                         double rate_hz);

/// Returns true if a clock offset is significant and large enough to degrade the
/// calibration.
[[nodiscard]] bool clocks_disagree(const std::vector<ApparentClock>& clocks);

}  // namespace marey::calib
