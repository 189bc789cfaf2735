// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include "calib/bundle/bundle_problem.h"

namespace marey::calib {
namespace {

using RowSparse = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;
using SparseColumns = Eigen::SparseMatrix<double>;

constexpr int kLensBlock = Intrinsics::kParameterCount;

// Relative to a corner's sigma. On rendered boards, with four thousand corners per
// camera, errors of cameras are two to five times those of independent corners.
constexpr double kCommonShare = 0.03;

/// Returns the covariance of the first `shared` columns of a normal matrix, the others
/// eliminated.
std::optional<Eigen::MatrixXd> leading_covariance(const SparseColumns& normal,
                                                  int shared) {
  Eigen::MatrixXd information = Eigen::MatrixXd(normal.topLeftCorner(shared, shared));
  const int rest = static_cast<int>(normal.cols()) - shared;
  if (rest > 0) {
    const SparseColumns poses = normal.bottomRightCorner(rest, rest);
    const Eigen::MatrixXd mixed = Eigen::MatrixXd(normal.bottomLeftCorner(rest, shared));
    const Eigen::SimplicialLDLT<SparseColumns> factor(poses);
    if (factor.info() != Eigen::Success) return std::nullopt;
    information -= mixed.transpose() * factor.solve(mixed);
  }
  // Radians, metres and pixels: scaled for comparison.
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const Eigen::MatrixXd unit =
      scale.cwiseInverse().asDiagonal() * information * scale.cwiseInverse().asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> factor(unit);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(shared, shared));
  return scale.cwiseInverse().asDiagonal() * inverse * scale.cwiseInverse().asDiagonal();
}

SparseColumns sparse_of(const ceres::CRSMatrix& crs) {
  return Eigen::Map<const RowSparse>(crs.num_rows,
                                     crs.num_cols,
                                     static_cast<Eigen::Index>(crs.values.size()),
                                     crs.rows.data(),
                                     crs.cols.data(),
                                     crs.values.data());
}

/// Returns the covariance in the order of RigCovariance; `columns` are a camera's columns
/// in `covariance`, -1 for held parameters.
RigCovariance scattered(const Eigen::MatrixXd& covariance,
                        const std::vector<int>& columns,
                        std::size_t cameras) {
  RigCovariance out;
  out.cameras = cameras;
  const std::size_t size = out.size();
  out.values.assign(size * size, 0.0);
  for (std::size_t row = 0; row < size; ++row) {
    for (std::size_t column = 0; column < size; ++column) {
      if (columns[row] < 0 || columns[column] < 0) continue;
      out.values[row * size + column] = covariance(columns[row], columns[column]);
    }
  }
  return out;
}

}  // namespace

std::vector<double*> BundleProblem::shared_blocks() {
  std::vector<double*> blocks;
  for (CameraBlock& c : cameras_) {
    for (double* block :
         {c.lens.data(), c.pose.data(), c.clock.data(), c.shrinkage.data()}) {
      if (moves(block)) blocks.push_back(block);
    }
  }
  for (TargetBlock& t : targets_) {
    for (PieceBlock& piece : t.pieces) {
      if (moves(piece.data())) blocks.push_back(piece.data());
    }
    if (moves(t.warp.data())) blocks.push_back(t.warp.data());
  }
  return blocks;
}

std::vector<double*> BundleProblem::pose_blocks() {
  std::vector<double*> blocks;
  for (TargetBlock& t : targets_) {
    for (auto& [instant, pose] : t.poses) {
      if (moves(pose.data())) blocks.push_back(pose.data());
    }
  }
  return blocks;
}

std::vector<int> BundleProblem::columns_of_cameras(
    const std::map<const double*, int>& first) const {
  std::vector<int> columns(RigCovariance::kPerCamera * cameras_.size(), -1);
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    const std::size_t at = RigCovariance::kPerCamera * c;
    const auto lens = first.find(cameras_[c].lens.data());
    const auto pose = first.find(cameras_[c].pose.data());
    for (int i = 0; i < kLensBlock && lens != first.end(); ++i) {
      columns[at + static_cast<std::size_t>(i)] = lens->second + i;
    }
    for (int i = 0; i < 6 && pose != first.end(); ++i) {
      columns[at + static_cast<std::size_t>(kLensBlock + i)] = pose->second + i;
    }
  }
  return columns;
}

ClockSigma BundleProblem::clock_sigma(std::size_t c,
                                      int first,
                                      const Eigen::MatrixXd& covariance) const {
  const double* clock = cameras_[c].clock.data();
  const int count = problem_.ParameterBlockTangentSize(clock);
  Eigen::MatrixXd plus = Eigen::MatrixXd::Identity(3, count);
  if (const ceres::Manifold* manifold = problem_.GetManifold(clock)) {
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> p(3, count);
    manifold->PlusJacobian(clock, p.data());
    plus = p;
  }
  const Eigen::Matrix3d full =
      plus * covariance.block(first, first, count, count) * plus.transpose();
  return {std::sqrt(full(0, 0)), std::sqrt(full(1, 1)), std::sqrt(full(2, 2))};
}

double BundleProblem::sigma_factor(double cost, int numbers) const {
  double factor = 1.0;
  const int freedom = residuals_ - numbers;
  if (freedom > 0) factor = std::max(1.0, std::sqrt(2.0 * cost / freedom));
  // Errors that a lens, a print or a detector cause equally in all corners do not average
  // out.
  const double corners = 0.5 * residuals_ / static_cast<double>(cameras_.size());
  return factor * std::sqrt(1.0 + kCommonShare * kCommonShare * corners);
}

std::optional<RigUncertainty> BundleProblem::uncertainty() {
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = shared_blocks();
  std::map<const double*, int> first;
  int shared = 0;
  for (const double* block : options.parameter_blocks) {
    first[block] = shared;
    shared += problem_.ParameterBlockTangentSize(block);
  }
  const std::vector<double*> poses = pose_blocks();
  options.parameter_blocks.insert(
      options.parameter_blocks.end(), poses.begin(), poses.end());
  ceres::CRSMatrix crs;
  double cost = 0.0;
  if (!problem_.Evaluate(options, &cost, nullptr, nullptr, &crs)) return std::nullopt;
  const SparseColumns columns = sparse_of(crs);
  const SparseColumns normal = SparseColumns(columns.transpose()) * columns;
  auto covariance = leading_covariance(normal, shared);
  if (!covariance) return std::nullopt;

  RigUncertainty uncertainty;
  uncertainty.sigma_factor = sigma_factor(cost, crs.num_cols);
  *covariance *= uncertainty.sigma_factor * uncertainty.sigma_factor;
  uncertainty.covariance =
      scattered(*covariance, columns_of_cameras(first), cameras_.size());
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    const auto clock = first.find(cameras_[c].clock.data());
    uncertainty.clocks.push_back(
        clock != first.end() ? clock_sigma(c, clock->second, *covariance) : ClockSigma{});
  }
  return uncertainty;
}

}  // namespace marey::calib
