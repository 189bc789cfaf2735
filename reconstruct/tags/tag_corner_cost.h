// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: Ceres cost of one sighting of one tag of a known body, with
// analytic derivatives (posture_derivatives.h).

#include <array>
#include <span>
#include <vector>

#include <ceres/ceres.h>

#include "reconstruct/tags/body_model.h"
#include "reconstruct/tags/soft_tissue_noise.h"
#include "reconstruct/tags/tag_sight.h"

namespace marey::reconstruct {

/// Eight residuals in sigmas: predicted minus seen. Their blocks are those of
/// parameters_of(bone), in that order; after set_late() one more, the camera's lateness.
/// [s] A corner behind the camera has a constant cost: such a posture is wrong, but the
/// solver must be able to leave it. Some 10 microseconds with derivatives.
class TagCornerCost final : public ceres::CostFunction {
 public:
  /// Precondition: the tag has a place.
  TagCornerCost(const BodyModel& model,
                const TagSighting& sighting,
                std::span<const Camera> cameras);

  /// Adds a block for the camera's lateness; the corners move at this speed. The slip of
  /// the tag is not an error of its corners: residuals along its directions are scaled
  /// down, so that all have unit variance (soft_tissue_noise.h).
  void set_late(const std::array<glm::dvec2, 4>& velocity_px_s, const TagSlip& slip);

  bool Evaluate(double const* const* parameters,
                double* residuals,
                double** jacobians) const override;

 private:
  using Rows = Eigen::Matrix<double, 8, Eigen::Dynamic, 0, 8, SparseDerivative::kMax>;
  void fill(const double* const* parameters,
            const SparseDerivative& where,
            const Rows& by_unknown,
            double** jacobians) const;

  HumanBone bone_;
  std::vector<PoseParameter> parameters_;
  Lengths lengths_;
  BodyConstants body_;
  TagSight sight_;
  double sigma_px_;
  std::array<glm::dvec2, 4> corners_px_;
  std::array<Eigen::Vector3d, 4> corners_in_bone_;
  bool is_late_ = false;
  Eigen::Matrix<double, 8, 1> by_lateness_ = Eigen::Matrix<double, 8, 1>::Zero();
  Eigen::Matrix<double, 8, 3> slip_directions_ = Eigen::Matrix<double, 8, 3>::Zero();
  Eigen::Vector3d slip_shrink_ = Eigen::Vector3d::Zero();
};

/// Robust loss of a tag's eight residuals, whose norm is near 2.8 for inliers.
[[nodiscard]] ceres::LossFunction* tag_loss();

/// Adds the reprojection of one sighting to a problem in which the body is known.
void add_sighting(const BodyModel& model,
                  const TagSighting& sighting,
                  std::span<const Camera> cameras,
                  Posture& posture,
                  ceres::Problem& problem);

/// Adds the reprojection for a camera that is late by the block `offset_s`, while the
/// corners move at `velocity_px_s`, and for a tag that slips. Precondition: the tag has a
/// place.
ceres::ResidualBlockId add_late_sighting(const BodyModel& model,
                                         const TagSighting& sighting,
                                         std::span<const Camera> cameras,
                                         Posture& posture,
                                         ceres::Problem& problem,
                                         double* offset_s,
                                         const std::array<glm::dvec2, 4>& velocity_px_s,
                                         const TagSlip& slip);

}  // namespace marey::reconstruct
