// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: joint solution of the postures of neighbouring frames.

#include <span>
#include <vector>

#include <Eigen/Dense>

#include "calib/plan/body_information.h"
#include "calib/plan/posture_jacobian.h"

namespace marey::calib {

/// Expected uncertainty of a frame's posture.
struct PostureUncertainty {
  PostureMatrix covariance;   ///< From the noise of corners, with exact shared columns.
  Eigen::MatrixXd by_shared;  ///< Derivative of the posture by errors of shared columns.
};

/// Solves the frames together with the steps between them: one minimum over all of them,
/// like marey's windows. The frames' information includes the posture prior. Block
/// tridiagonal in pairs of frames. Cost: some 4 ms per frame. Preconditions: an even
/// number of frames, 2 or more; each with a positive definite posture.
[[nodiscard]] std::vector<PostureUncertainty> solve_chain(
    std::span<const FrameInformation> frames, const StepPrior& steps);

}  // namespace marey::calib
