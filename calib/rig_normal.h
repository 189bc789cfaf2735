// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: the normal equations of a refined model, for tests of what the
// refinement held fixed.

#include <optional>
#include <vector>

#include <Eigen/Dense>

#include "calib/rig_rows.h"

namespace marey::calib {

/// Information of all columns and the right side, in sigmas: cost(x) = cost(0) -
/// 2 right' x + x' information x, poses of moving targets eliminated.
struct RigNormal {
  Eigen::MatrixXd information;
  Eigen::VectorXd right;
};

/// What the columns do to one camera's picture: the mean, over the sightings of a window,
/// of the squared pixels that a step of the camera's pose moves a corner by.
using PixelsByPose = Eigen::Matrix<double, 6, 6>;

/// The normal equations at the model's numbers. Sightings that the refinement left out
/// count too, each with the weight of a Cauchy loss at three times what is usual of its
/// camera; what is usual is at least its sigma. nullopt where poses cannot be eliminated.
/// Cost: some tenths of a second for four cameras and a hundred instants.
[[nodiscard]] std::optional<RigNormal> rig_normal(const RigModel& model,
                                                  const RigColumns& columns,
                                                  const RefineOptions& refine,
                                                  const RigRowOptions& options);

/// Per camera and window, [c][w]; zero where it saw nothing.
[[nodiscard]] std::vector<std::vector<PixelsByPose>> pixels_by_pose(
    const RigModel& model,
    const RigColumns& columns,
    const RefineOptions& refine,
    const RigRowOptions& options);

}  // namespace marey::calib
