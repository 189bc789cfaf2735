// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: uncertainty of a planned body's measurement.

#include <span>

#include <Eigen/Dense>

#include "calib/plan/body_information.h"

namespace marey::calib {

/// Returns the covariance of the shared columns: of lengths and tags after a bundle over
/// standing still and moving every joint at `floor_m`, and of the cameras, including the
/// errors that the body inherits from them.
[[nodiscard]] Eigen::MatrixXd subject_uncertainty(std::span<const Camera> cameras,
                                                  const RigCovariance* covariance,
                                                  const PlannedBody& body,
                                                  const glm::dvec2& floor_m,
                                                  const CornerSigma& corner_sigma,
                                                  const PlanOptions& options,
                                                  const SharedColumns& columns);

}  // namespace marey::calib
