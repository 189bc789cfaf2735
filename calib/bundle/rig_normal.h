// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: the normal equations of a refined model, to test parameters that the
// refinement held fixed.

#include <optional>
#include <vector>

#include <Eigen/Dense>

#include "calib/bundle/rig_rows.h"

namespace marey::calib {

/// Information of all columns and the right side, in sigmas: cost(x) = cost(0) - 2 right'
/// x + x' information x, with poses of moving targets eliminated.
struct RigNormal {
  Eigen::MatrixXd information;
  Eigen::VectorXd right;
};

/// Effect of the columns on one camera's image: the mean, over the sightings of a window,
/// of the squared displacement [px] of a corner by a step of the camera's pose.
using PixelsByPose = Eigen::Matrix<double, 6, 6>;

/// Computes the normal equations at the model's parameters. Sightings that the refinement
/// excluded count too, each with the weight of a Cauchy loss at three times the typical
/// error of its camera, which is at least its sigma. Returns nullopt if poses cannot be
/// eliminated. Cost: some tenths of a second for four cameras and a hundred instants.
[[nodiscard]] std::optional<RigNormal> rig_normal(const RigModel& model,
                                                  const RigColumns& columns,
                                                  const RefineOptions& refine,
                                                  const RigRowOptions& options);

/// Returns the effect per camera and window, [c][w]; zero without sightings.
[[nodiscard]] std::vector<std::vector<PixelsByPose>> pixels_by_pose(
    const RigModel& model,
    const RigColumns& columns,
    const RefineOptions& refine,
    const RigRowOptions& options);

}  // namespace marey::calib
