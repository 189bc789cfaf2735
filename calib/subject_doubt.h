// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: how well a planned body would be measured.

#include <span>

#include <Eigen/Dense>

#include "calib/body_information.h"

namespace marey::calib {

/// Covariance of the shared columns: of lengths and tags after a bundle over standing
/// still and moving every joint at `floor_m`, and of the cameras, with what the body
/// takes over from their errors.
[[nodiscard]] Eigen::MatrixXd subject_doubt(std::span<const Camera> cameras,
                                            const RigCovariance* covariance,
                                            const PlannedBody& body,
                                            const glm::dvec2& floor_m,
                                            const CornerSigma& corner_sigma,
                                            const PlanOptions& options,
                                            const SharedColumns& columns);

}  // namespace marey::calib
