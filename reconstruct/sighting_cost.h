// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: one sighting of one tag of a known body as Ceres wants it, with
// derivatives written out (posture_derivatives.h).

#include <array>
#include <vector>

#include <ceres/cost_function.h>

#include "reconstruct/body_model.h"
#include "reconstruct/tag_sight.h"

namespace marey::reconstruct {

/// Eight residuals in sigmas: predicted minus seen. Their blocks are those of
/// slots_of(bone), in that order; after set_late() one more, the camera's lateness. [s]
/// A corner behind the camera costs a constant: such a posture is wrong, but not
/// impossible to leave. Some 10 microseconds with derivatives.
class SightingCost final : public ceres::CostFunction {
 public:
  /// Precondition: the tag has a place.
  SightingCost(const BodyModel& model,
               const TagSighting& sighting,
               std::span<const Camera> cameras);

  /// The camera is late by a further block while its corners move at this speed. What the
  /// tag slips by is no error of its corners: residuals along its directions shrink, so
  /// that all have unit variance (tag_slip.h).
  void set_late(const std::array<glm::dvec2, 4>& velocity_px_s, const TagSlip& slip);

  bool Evaluate(double const* const* parameters,
                double* residuals,
                double** jacobians) const override;

 private:
  using Rows = Eigen::Matrix<double, 8, Eigen::Dynamic, 0, 8, SparseDerivative::kMost>;
  void fill(const double* const* parameters,
            const SparseDerivative& where,
            const Rows& by_unknown,
            double** jacobians) const;

  HumanBone bone_;
  std::vector<Slot> slots_;
  Lengths lengths_;
  BodyFrame body_;
  TagSight sight_;
  double sigma_px_;
  std::array<glm::dvec2, 4> corners_px_;
  std::array<Eigen::Vector3d, 4> corners_in_bone_;
  bool is_late_ = false;
  Eigen::Matrix<double, 8, 1> by_lateness_ = Eigen::Matrix<double, 8, 1>::Zero();
  Eigen::Matrix<double, 8, 3> slip_directions_ = Eigen::Matrix<double, 8, 3>::Zero();
  Eigen::Vector3d slip_shrink_ = Eigen::Vector3d::Zero();
};

}  // namespace marey::reconstruct
