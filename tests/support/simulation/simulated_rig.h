// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/camera.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::testing {

/// The cameras of a session as they are, and as its calibration has them.
struct SimulatedRig {
  std::string layout;  ///< "ring" or "arc".
  std::vector<Camera> cameras;
  std::vector<Camera> calibrated;
  /// Standard deviation of each calibrated centre, per coordinate. [m]
  std::vector<double> centre_sigma_m;
  double heading_rad = 0.0;  ///< Heading towards the cameras (Angle::kHeading).
};

/// Draws two to six cameras on a ring of 2.5 to 5 m about the origin, 0.5 to 2.6 m high,
/// evenly or within an arc of at most 120 degrees; 720p and 1080p, focal lengths of 700
/// to 1400 px, with distortion. A person of 2 m at the origin is in all pictures.
///
/// Calibrated centres are off by 1 to 3 mm. Rotations and focal lengths compensate for
/// this error in the middle of the volume, as after a bundle adjustment. The residual
/// there is tenths of a pixel.
[[nodiscard]] SimulatedRig draw_rig(Dice& dice);

}  // namespace marey::testing
