// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: what a problem's residuals say of its unknowns.

#include <optional>
#include <vector>

#include <Eigen/Sparse>
#include <ceres/ceres.h>

namespace marey::reconstruct {

/// J^T J of the problem over `blocks`, in their order and tangent spaces, losses applied:
/// the inverse of the covariance. nullopt when Ceres cannot evaluate a residual.
/// Precondition: every block is in the problem.
[[nodiscard]] std::optional<Eigen::SparseMatrix<double, Eigen::RowMajor, int>>
normal_matrix(ceres::Problem& problem, std::vector<double*> blocks);

}  // namespace marey::reconstruct
