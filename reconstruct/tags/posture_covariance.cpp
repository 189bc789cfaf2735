// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/posture_covariance.h"

#include <cmath>
#include <utility>

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include "reconstruct/posture/normal_matrix.h"
#include "reconstruct/posture/point_sigma.h"
#include "reconstruct/posture/posture_derivatives.h"

namespace marey::reconstruct {
namespace {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;
using Dense = Eigen::MatrixXd;
constexpr int kN = kPostureFreedom;

/// Computes the diagonal blocks of the inverse of a symmetric block-tridiagonal matrix;
/// empty if it is not positive definite.
std::vector<Dense> inverse_diagonal(const Sparse& matrix, int block) {
  const int size = static_cast<int>(matrix.rows());
  const int count = (size + block - 1) / block;
  const auto start = [&](int i) { return i * block; };
  const auto width = [&](int i) { return std::min(block, size - i * block); };
  std::vector<Dense> pivot_inverse;
  std::vector<Dense> factor;  // L_i = B_i * pivot_inverse_{i-1}
  for (int i = 0; i < count; ++i) {
    Dense pivot = matrix.block(start(i), start(i), width(i), width(i));
    pivot.diagonal().array() += 1e-9;
    if (i > 0) {
      const Dense below = matrix.block(start(i), start(i - 1), width(i), width(i - 1));
      factor.push_back(below * pivot_inverse.back());
      pivot -= factor.back() * below.transpose();
    } else {
      factor.emplace_back();
    }
    const Eigen::LLT<Dense> factored(pivot);
    if (factored.info() != Eigen::Success) return {};
    pivot_inverse.push_back(factored.solve(Dense::Identity(width(i), width(i))));
  }
  std::vector<Dense> diagonal(static_cast<std::size_t>(count));
  for (int i = count - 1; i >= 0; --i) {
    const auto at = static_cast<std::size_t>(i);
    diagonal[at] = pivot_inverse[at];
    if (i + 1 < count) {
      diagonal[at] += factor[at + 1].transpose() * diagonal[at + 1] * factor[at + 1];
    }
  }
  return diagonal;
}

/// Ceres' column for a column of column_of(), and the ratio of their steps.
struct CeresColumn {
  int column = 0;
  double scale = 1.0;
};

std::array<CeresColumn, kN> ceres_columns() {
  std::array<CeresColumn, kN> columns{};
  int column = 0;
  for (const PoseParameter parameter : kAllPoseParameters) {
    for (int i = 0; i < tangent_size(parameter); ++i) {
      // A rotation turns by twice the step of EigenQuaternionManifold.
      columns[static_cast<std::size_t>(column_of(parameter) + i)] = {
          column + i, is_rotation(parameter) ? 2.0 : 1.0};
    }
    column += tangent_size(parameter);
  }
  return columns;
}

/// Returns the sigma of a point. [m]
double sigma_of(const SparseDerivative& point, const Dense& covariance) {
  static const std::array<CeresColumn, kN> columns = ceres_columns();
  const auto at = [&](int i) {
    return columns[static_cast<std::size_t>(point.column[static_cast<std::size_t>(i)])];
  };
  Eigen::Matrix3d of_point = Eigen::Matrix3d::Zero();
  for (int i = 0; i < point.columns; ++i) {
    Eigen::Vector3d spread = Eigen::Vector3d::Zero();
    for (int j = 0; j < point.columns; ++j) {
      spread += at(j).scale * covariance(at(i).column, at(j).column) * point.value.col(j);
    }
    of_point += at(i).scale * point.value.col(i) * spread.transpose();
  }
  return point_sigma_m(of_point);
}

}  // namespace

std::optional<std::vector<Dense>> posture_covariances(std::span<Posture> postures,
                                                      ceres::Problem& problem) {
  std::vector<double*> blocks;
  for (Posture& posture : postures) {
    for (const PoseParameter parameter : kAllPoseParameters)
      blocks.push_back(posture.block(parameter));
  }
  const auto normal = normal_matrix(problem, std::move(blocks));
  if (!normal) return std::nullopt;
  const std::vector<Dense> pairs = inverse_diagonal(*normal, 2 * kN);
  if (pairs.empty()) return std::nullopt;
  std::vector<Dense> covariances;
  for (std::size_t f = 0; f < postures.size(); ++f) {
    const int within = static_cast<int>(f % 2) * kN;
    covariances.emplace_back(pairs[f / 2].block(within, within, kN, kN));
  }
  return covariances;
}

BoneSigmas bone_sigmas(const BodyModel& model,
                       const Posture& posture,
                       const Dense& covariance) {
  UnfoldedPosture unfolded;
  unfolded.unfold(posture, model.lengths, model.body);
  SparseDerivative point;
  BoneSigmas sigmas{};
  for (const HumanBone bone : human_bones()) {
    const HumanBone mover = solved_segment(bone);
    unfolded.derivative(mover, unfolded.origin(mover), point);
    sigmas[index(bone)] = sigma_of(point, covariance);
  }
  return sigmas;
}

TagSigmas tag_sigmas(const BodyModel& model,
                     const Posture& posture,
                     const Dense& covariance) {
  UnfoldedPosture unfolded;
  unfolded.unfold(posture, model.lengths, model.body);
  SparseDerivative point;
  TagSigmas sigmas(model.tags.size(), 0.0);
  for (const auto& [tag, segment_from_tag] : model.segment_from_tag) {
    const HumanBone bone = model.bone(tag);
    unfolded.derivative(
        bone, unfolded.point(bone, eigen(segment_from_tag.translation)), point);
    sigmas[tag] = sigma_of(point, covariance);
  }
  return sigmas;
}

}  // namespace marey::reconstruct
