// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/tag_corner_cost.h"

#include <algorithm>
#include <memory>

#include "core/base/assert.h"
#include "core/base/cross_matrix.h"
#include "reconstruct/posture/posture_terms.h"
#include "reconstruct/tags/tag_loss.h"

namespace marey::reconstruct {
namespace {

constexpr double kBehind = 1e3;

/// Derivative of Ceres' quaternion (x, y, z, w) by a small rotation vector in the world:
/// half of EigenQuaternionManifold's. Twice its transpose converts derivatives by the
/// rotation vector to derivatives by the quaternion.
Eigen::Matrix<double, 4, 3> quaternion_by_half_turn(const double* q) {
  const Eigen::Vector3d v(q[0], q[1], q[2]);
  Eigen::Matrix<double, 4, 3> by_turn;
  by_turn.topRows<3>() =
      q[3] * Eigen::Matrix3d::Identity() - cross_matrix<Eigen::Matrix3d>(v);
  by_turn.bottomRows<1>() = -v.transpose();
  return by_turn;
}

}  // namespace

TagCornerCost::TagCornerCost(const BodyModel& model,
                             const TagSighting& sighting,
                             std::span<const Camera> cameras)
    : bone_(model.bone(sighting.tag)),
      parameters_(parameters_of(bone_)),
      lengths_(model.lengths),
      body_(model.body),
      sight_(cameras[index(sighting.camera)]),
      sigma_px_(sighting.detection->sigma_px),
      corners_px_(sighting.detection->corners_px) {
  const RigidTransform* bone_from_tag = model.place(sighting.tag);
  MAREY_ASSERT(bone_from_tag);
  for (int c = 0; c < 4; ++c) {
    corners_in_bone_[static_cast<std::size_t>(c)] =
        eigen(*bone_from_tag * corner_in_tag(c, model.tags[sighting.tag].size_m));
  }
  for (const PoseParameter parameter : parameters_)
    mutable_parameter_block_sizes()->push_back(block_size(parameter));
  set_num_residuals(8);
}

void TagCornerCost::set_late(const std::array<glm::dvec2, 4>& velocity_px_s,
                             const TagSlip& slip) {
  MAREY_ASSERT(!is_late_);
  is_late_ = true;
  for (std::size_t c = 0; c < 4; ++c) {
    const auto row = static_cast<Eigen::Index>(2 * c);
    by_lateness_[row] = velocity_px_s[c].x / sigma_px_;
    by_lateness_[row + 1] = velocity_px_s[c].y / sigma_px_;
  }
  slip_directions_ = slip.directions;
  slip_shrink_ = 1.0 - slip.stretch().inverse();
  mutable_parameter_block_sizes()->push_back(1);
}

bool TagCornerCost::Evaluate(double const* const* parameters,
                             double* residuals,
                             double** jacobians) const {
  Posture posture;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    std::copy_n(parameters[i], block_size(parameters_[i]), posture.block(parameters_[i]));
  }
  UnfoldedPosture unfolded;
  unfolded.unfold(posture, lengths_, body_);
  Eigen::Map<Eigen::Matrix<double, 8, 1>> out(residuals);
  SparseDerivative point;
  Rows by_unknown;
  for (std::size_t c = 0; c < 4; ++c) {
    const auto row = static_cast<Eigen::Index>(2 * c);
    const Eigen::Vector3d p = unfolded.point(bone_, corners_in_bone_[c]);
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> px_by_world;
    const bool is_before = sight_.project(p, pixel, px_by_world);
    if (jacobians) {
      unfolded.derivative(bone_, p, point);
      if (c == 0) by_unknown.setZero(8, point.columns);
    }
    if (!is_before) {
      out.segment<2>(row).setConstant(kBehind);
      continue;
    }
    out[row] = (pixel.x() - corners_px_[c].x) / sigma_px_;
    out[row + 1] = (pixel.y() - corners_px_[c].y) / sigma_px_;
    if (jacobians) {
      by_unknown.middleRows<2>(row).noalias() =
          (px_by_world / sigma_px_).lazyProduct(point.value.leftCols(point.columns));
    }
  }
  if (is_late_) out += *parameters[parameters_.size()] * by_lateness_;
  const auto shrink = [this](auto&& rows) {
    for (int k = 0; k < 3; ++k) {
      if (slip_shrink_[k] == 0.0) continue;
      const auto direction = slip_directions_.col(k);
      for (Eigen::Index i = 0; i < rows.cols(); ++i) {
        rows.col(i) -= slip_shrink_[k] * direction.dot(rows.col(i)) * direction;
      }
    }
  };
  shrink(out);
  if (!jacobians) return true;
  shrink(by_unknown);
  fill(parameters, point, by_unknown, jacobians);
  if (is_late_ && jacobians[parameters_.size()]) {
    Eigen::Map<Eigen::Matrix<double, 8, 1>> by_lateness(jacobians[parameters_.size()]);
    by_lateness = by_lateness_;
    shrink(by_lateness);
  }
  return true;
}

/// Distributes the columns of the posture's unknowns over Ceres' blocks.
void TagCornerCost::fill(const double* const* parameters,
                         const SparseDerivative& where,
                         const Rows& by_unknown,
                         double** jacobians) const {
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    if (!jacobians[i]) continue;
    const PoseParameter parameter = parameters_[i];
    const auto end = where.column.begin() + where.columns;
    const auto found = std::find(where.column.begin(), end, column_of(parameter));
    const auto at = static_cast<Eigen::Index>(found - where.column.begin());
    Eigen::Map<Eigen::Matrix<double, 8, Eigen::Dynamic, Eigen::RowMajor>> block(
        jacobians[i], 8, block_size(parameter));
    if (found == end) {
      block.setZero();
    } else if (is_rotation(parameter)) {
      block = 2.0 * by_unknown.middleCols<3>(at) *
              quaternion_by_half_turn(parameters[i]).transpose();
    } else {
      block = by_unknown.middleCols(at, block_size(parameter));
    }
  }
}

ceres::LossFunction* tag_loss() {
  return new ceres::CauchyLoss(kTagLossSigmas);
}

void add_sighting(const BodyModel& model,
                  const TagSighting& sighting,
                  std::span<const Camera> cameras,
                  Posture& posture,
                  ceres::Problem& problem) {
  if (!model.place(sighting.tag)) return;
  problem.AddResidualBlock(new TagCornerCost(model, sighting, cameras),
                           tag_loss(),
                           blocks_of(posture, model.bone(sighting.tag)));
}

ceres::ResidualBlockId add_late_sighting(const BodyModel& model,
                                         const TagSighting& sighting,
                                         std::span<const Camera> cameras,
                                         Posture& posture,
                                         ceres::Problem& problem,
                                         double* offset_s,
                                         const std::array<glm::dvec2, 4>& velocity_px_s,
                                         const TagSlip& slip) {
  auto cost = std::make_unique<TagCornerCost>(model, sighting, cameras);
  cost->set_late(velocity_px_s, slip);
  std::vector<double*> blocks = blocks_of(posture, model.bone(sighting.tag));
  blocks.push_back(offset_s);
  return problem.AddResidualBlock(cost.release(), tag_loss(), blocks);
}

}  // namespace marey::reconstruct
