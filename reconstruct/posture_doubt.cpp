// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture_doubt.h"

#include <cmath>
#include <utility>

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include "reconstruct/normal_matrix.h"
#include "reconstruct/point_sigma.h"

namespace marey::reconstruct {
namespace {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;
using Dense = Eigen::MatrixXd;
constexpr int kN = kPostureFreedom;

/// Diagonal blocks of the inverse of a symmetric block-tridiagonal matrix.
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
    pivot_inverse.push_back(pivot.ldlt().solve(Dense::Identity(width(i), width(i))));
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

/// A posture over its tangent, Ceres' own.
class PostureJets {
 public:
  using Jet = ceres::Jet<double, kN>;

  explicit PostureJets(const Posture& posture) {
    const ceres::EigenQuaternionManifold manifold;
    int column = 0;
    for (const Slot slot : kAllSlots) {
      const int offset = storage_offset(slot);
      blocks_[index(slot)] = &values_[static_cast<std::size_t>(offset)];
      Eigen::Matrix<double, 4, 3, Eigen::RowMajor> plus;
      if (is_rotation(slot)) manifold.PlusJacobian(posture.block(slot), plus.data());
      for (int i = 0; i < block_size(slot); ++i) {
        Jet& value = values_[static_cast<std::size_t>(offset + i)];
        value = Jet(posture.block(slot)[i]);
        if (is_rotation(slot)) {
          value.v.segment<3>(column) = plus.row(i);
        } else {
          value.v[column + i] = 1.0;
        }
      }
      column += tangent_size(slot);
    }
  }
  PostureJets(const PostureJets&) = delete;  // blocks_ points into values_.
  PostureJets& operator=(const PostureJets&) = delete;

  [[nodiscard]] BoneFrame<Jet> frame(const BodyModel& model, HumanBone bone) const {
    return bone_frame<Jet, double>(solved_segment(bone),
                                   std::span<const Jet* const, kSlotCount>(blocks_),
                                   model.lengths.data(),
                                   model.body);
  }

 private:
  std::array<Jet, kPostureStorage> values_;
  std::array<const Jet*, kSlotCount> blocks_{};
};

/// Of a point. [m]
double sigma_of(const Eigen::Matrix<PostureJets::Jet, 3, 1>& p, const Dense& covariance) {
  Eigen::Matrix3d of_point;
  for (int column = 0; column < 3; ++column) {
    const auto spread = (covariance * p[column].v).eval();
    for (int row = 0; row < 3; ++row) of_point(row, column) = p[row].v.dot(spread);
  }
  return point_sigma_m(of_point);
}

}  // namespace

std::optional<std::vector<Dense>> posture_covariances(std::span<Posture> postures,
                                                      ceres::Problem& problem) {
  std::vector<double*> blocks;
  for (Posture& posture : postures) {
    for (const Slot slot : kAllSlots) blocks.push_back(posture.block(slot));
  }
  const auto normal = normal_matrix(problem, std::move(blocks));
  if (!normal) return std::nullopt;
  const std::vector<Dense> pairs = inverse_diagonal(*normal, 2 * kN);
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
  const PostureJets jets(posture);
  BoneSigmas sigmas{};
  for (const HumanBone bone : human_bones()) {
    sigmas[index(bone)] = sigma_of(jets.frame(model, bone).origin, covariance);
  }
  return sigmas;
}

TagSigmas tag_sigmas(const BodyModel& model,
                     const Posture& posture,
                     const Dense& covariance) {
  const PostureJets jets(posture);
  TagSigmas sigmas(model.tags.size(), 0.0);
  for (const auto& [tag, segment_from_tag] : model.segment_from_tag) {
    const auto frame = jets.frame(model, model.bone(tag));
    const Eigen::Matrix<PostureJets::Jet, 3, 1> centre =
        frame.origin +
        frame.rotation * detail::vec<PostureJets::Jet>(segment_from_tag.translation);
    sigmas[tag] = sigma_of(centre, covariance);
  }
  return sigmas;
}

}  // namespace marey::reconstruct
