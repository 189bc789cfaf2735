// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: sightings of a refined model, linearised.

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "calib/bundle/rig_columns.h"

namespace marey::calib {

/// A sighting's residuals in sigmas (seen minus expected), and their derivatives.
struct SightingRows {
  Eigen::VectorXd residual;
  Eigen::MatrixXd shared;    ///< By `columns`.
  std::vector<int> columns;  ///< Of RigColumns.
  Eigen::MatrixXd pose;      ///< Six columns, or six for each of four knots.
  Eigen::MatrixXd camera;    ///< By a step of the camera's pose.
  int first_knot = 0;        ///< For a target with knots.
};

struct RigRowOptions {
  double rate_hz = 0.0;  ///< For the instants of targets without knots.
  /// Returns the window of a sighting: 0 to windows - 1; below 0 (or an empty function):
  /// in none.
  std::function<int(const Sighting&)> window_of;
};

/// Returns the rows of a sighting; nullopt if the target has no pose at its time, or a
/// corner is behind the camera. For targets with a pose at every instant, the derivative
/// by time is from velocity_at().
[[nodiscard]] std::optional<SightingRows> rows_of(const RigModel& model,
                                                  const RigColumns& columns,
                                                  const RefineOptions& refine,
                                                  const RigRowOptions& options,
                                                  const Sighting& sighting);

/// Returns the solver parameters of a pose.
[[nodiscard]] std::array<double, 7> pose_block(const RigidTransform& t);

}  // namespace marey::calib
