// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture/normal_matrix.h"

#include <utility>

namespace marey::reconstruct {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

std::optional<Sparse> normal_matrix(ceres::Problem& problem,
                                    std::vector<double*> blocks) {
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = std::move(blocks);
  ceres::CRSMatrix crs;
  if (!problem.Evaluate(options, nullptr, nullptr, nullptr, &crs)) return std::nullopt;
  const Eigen::Map<const Sparse> jacobian(crs.num_rows,
                                          crs.num_cols,
                                          static_cast<Eigen::Index>(crs.values.size()),
                                          crs.rows.data(),
                                          crs.cols.data(),
                                          crs.values.data());
  return Sparse(Sparse(jacobian.transpose()) * jacobian);
}

}  // namespace marey::reconstruct
