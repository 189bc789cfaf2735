// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: postures of neighbouring frames together.

#include <span>
#include <vector>

#include <Eigen/Dense>

#include "calib/body_freedom.h"
#include "calib/body_information.h"

namespace marey::calib {

/// How well a frame's posture would be known.
struct PostureDoubt {
  PostureMatrix covariance;   ///< From corners' noise, shared columns being exact.
  Eigen::MatrixXd by_shared;  ///< How the posture follows errors of shared columns.
};

/// Frames that the steps between them tie together: one minimum over all of them, as
/// marey's windows. Frames' information holds habits already. Block tridiagonal in pairs
/// of frames. Cost: some 4 ms per frame. Precondition: an even number of frames, 2 or
/// more; each with a positive definite posture.
[[nodiscard]] std::vector<PostureDoubt> solve_chain(
    std::span<const FrameInformation> frames, const StepPrior& steps);

}  // namespace marey::calib
