// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: sightings of a refined model, linearised.

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "calib/rig_columns.h"

namespace marey::calib {

/// A sighting's residuals in sigmas (seen from expected), and their derivatives.
struct SightingRows {
  Eigen::VectorXd residual;
  Eigen::MatrixXd shared;    ///< By `columns`.
  std::vector<int> columns;  ///< Of RigColumns.
  Eigen::MatrixXd pose;      ///< Six columns, or six for each of four knots.
  Eigen::MatrixXd camera;    ///< By a step of the camera's pose.
  int first_knot = 0;        ///< Of a target with knots.
};

struct RigRowOptions {
  double rate_hz = 0.0;  ///< Of the instants of targets without knots.
  /// The window of a sighting: 0 to windows - 1; below 0, or empty: in none.
  std::function<int(const Sighting&)> window_of;
};

/// nullopt where the target has no pose then, or a corner is behind the camera. Of
/// targets with a pose at every instant, time acts by velocity_at().
[[nodiscard]] std::optional<SightingRows> rows_of(const RigModel& model,
                                                  const RigColumns& columns,
                                                  const RefineOptions& refine,
                                                  const RigRowOptions& options,
                                                  const Sighting& sighting);

/// A pose as solvers move it.
[[nodiscard]] std::array<double, 7> pose_block(const RigidTransform& t);

}  // namespace marey::calib
