// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/camera_doubt.h"

#include <cmath>

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include "core/camera.h"

namespace marey::calib {
namespace {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

// Columns of one camera in the tangent space: intrinsics, rotation, centre, shrinkage.
constexpr int kCentreColumn = Intrinsics::kParameterCount + 3;
constexpr int kCameraColumns = kCentreColumn + 3 + 2;
constexpr int kBoardColumns = 6;

/// The normal matrix of all cameras, then all boards.
std::optional<Sparse> normal_matrix(std::span<const CameraBlocks> cameras,
                                    std::span<const BoardBlocks> boards,
                                    ceres::Problem& problem) {
  ceres::Problem::EvaluateOptions options;
  for (const CameraBlocks& c : cameras) {
    options.parameter_blocks.insert(
        options.parameter_blocks.end(),
        {c.intrinsics, c.world_from_camera_xyzw, c.camera_in_world, c.shrinkage});
  }
  for (const BoardBlocks& b : boards) {
    options.parameter_blocks.insert(options.parameter_blocks.end(),
                                    {b.world_from_board_xyzw, b.board_in_world});
  }
  ceres::CRSMatrix crs;
  if (!problem.Evaluate(options, nullptr, nullptr, nullptr, &crs)) return std::nullopt;
  const Eigen::Map<const Sparse> jacobian(crs.num_rows,
                                          crs.num_cols,
                                          static_cast<Eigen::Index>(crs.values.size()),
                                          crs.rows.data(),
                                          crs.cols.data(),
                                          crs.values.data());
  return Sparse(jacobian.transpose()) * jacobian;
}

}  // namespace

std::optional<std::vector<CameraSigmas>> camera_sigmas(
    std::span<const CameraBlocks> cameras,
    std::span<const BoardBlocks> boards,
    ceres::Problem& problem) {
  const auto normal = normal_matrix(cameras, boards, problem);
  if (!normal) return std::nullopt;
  const int n = kCameraColumns * static_cast<int>(cameras.size());
  Eigen::MatrixXd information = normal->topLeftCorner(n, n);
  for (std::size_t i = 0; i < boards.size(); ++i) {
    const int at = n + kBoardColumns * static_cast<int>(i);
    const Eigen::MatrixXd board = normal->block(at, at, kBoardColumns, kBoardColumns);
    const Eigen::MatrixXd shared = normal->block(at, 0, kBoardColumns, n);
    information -= shared.transpose() * board.ldlt().solve(shared);
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::MatrixXd covariance = factor.solve(Eigen::MatrixXd::Identity(n, n));
  std::vector<CameraSigmas> sigmas;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const int at = kCameraColumns * static_cast<int>(c);
    const auto variance = covariance.diagonal().segment<kCameraColumns>(at);
    sigmas.push_back({std::sqrt(variance.segment<3>(kCentreColumn).mean()),
                      std::sqrt(variance.head<2>().mean())});
  }
  return sigmas;
}

}  // namespace marey::calib
