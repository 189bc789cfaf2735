// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: normal matrix of a Ceres problem.

#include <optional>
#include <vector>

#include <Eigen/Sparse>
#include <ceres/ceres.h>

namespace marey::reconstruct {

/// Computes J^T J of the problem over `blocks`, in their order and tangent spaces, losses
/// applied: the inverse of the covariance. nullopt if Ceres cannot evaluate a residual.
/// Precondition: every block is in the problem.
[[nodiscard]] std::optional<Eigen::SparseMatrix<double, Eigen::RowMajor, int>>
normal_matrix(ceres::Problem& problem, std::vector<double*> blocks);

}  // namespace marey::reconstruct
