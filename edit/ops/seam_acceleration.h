// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "edit/find/planar_match.h"

#include "core/motion.h"

namespace marey::edit {

/// Accelerations of the bone's joint that accelerates most, as second differences.
/// [m/s^2]
struct SeamAcceleration {
  double seam = 0.0;    ///< The larger of the two frames next to the seam.
  double inside = 0.0;  ///< 95th percentile of all other frames.
};
/// Precondition: at least 4 frames; `step` moves the cycle to its repetition.
[[nodiscard]] SeamAcceleration seam_acceleration(const Motion& cycle,
                                                 const PlanarMove& step);

}  // namespace marey::edit
