// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: the joint refinement behind calibrate_cameras().

#include <map>
#include <span>
#include <vector>

#include "calib/board_views.h"
#include "core/camera.h"

namespace marey::calib {

struct BundleCamera {
  Intrinsics intrinsics;
  RigidTransform world_from_camera;
  TagShrinkage shrinkage;
  double centre_sigma_m = 0.0;  ///< Root mean square over the three coordinates.
  double focal_sigma_px = 0.0;
};

struct Bundle {
  std::vector<BundleCamera> cameras;
  std::map<int, RigidTransform> world_from_board;  ///< Per instant.
};

/// Minimises the reprojection of all board corners over intrinsics, camera poses and
/// board poses, the board on the floor held fixed: it is the world. Robust (Cauchy at 5
/// sigma of a tag's eight residuals together, which are 2.8 long when all is well). Weak
/// priors keep what a recording does not show (distortion of unseen image corners) at its
/// usual value. Fills the sigmas. False when the solver
/// finds no minimum, or one that leaves a camera free to move.
[[nodiscard]] bool bundle_adjust(std::span<const BoardView> views, Bundle& bundle);

}  // namespace marey::calib
