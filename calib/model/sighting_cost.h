// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: cost functions of the joint refinement.

#include <array>

#include <ceres/ceres.h>

#include "calib/model/rig_model.h"
#include "calib/model/spline_pose.h"

namespace marey::calib {

/// Solver parameters of a target's piece: a PoseBlock, then the logarithm of its size.
using PieceBlock = std::array<double, 8>;

/// offset [s], drift, line delay [s].
using ClockBlock = std::array<double, 3>;

/// The step of a PoseBlock or, with eight numbers, of a PieceBlock. Cost functions of
/// this folder give derivatives by the step itself, in the first columns of a block; the
/// last is zero.
class PoseManifold final : public ceres::Manifold {
 public:
  explicit PoseManifold(int numbers = 7, int steps = 6)
      : numbers_(numbers), steps_(steps) {}

  [[nodiscard]] int AmbientSize() const override { return numbers_; }
  [[nodiscard]] int TangentSize() const override { return steps_; }
  bool Plus(const double* x, const double* step, double* out) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* step) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;

 private:
  int numbers_;
  int steps_;
};

/// Moves only the size of a PieceBlock. Derivatives as for PoseManifold.
class SizeManifold final : public ceres::Manifold {
 public:
  [[nodiscard]] int AmbientSize() const override { return 8; }
  [[nodiscard]] int TangentSize() const override { return 1; }
  bool Plus(const double* x, const double* step, double* out) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* step) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

struct TargetPose;

/// Reprojection error of a sighting's corners, in sigmas. Blocks in order: intrinsics,
/// camera pose, target pose or the four knots around the time of the sighting; then, if
/// enabled: clock (with knots), shrinkage (tags), piece, warp.
class SightingCost final : public ceres::CostFunction {
 public:
  struct Parts {
    bool spline = false;
    bool shrinks = false;
    bool piece = false;
    bool warp = false;
  };
  /// Position of the sighting on the spline, by the camera's clock.
  struct Knots {
    double first_s = 0.0;  ///< Time of the second of the four knots.
    double spacing_s = 1.0;
  };

  SightingCost(const Sighting& sighting,
               const RigidTarget& target,
               LensModel lens,
               int height_px,
               Parts parts,
               Knots knots);

  bool Evaluate(const double* const* blocks,
                double* residuals,
                double** jacobians) const override;

 private:
  struct BlockIndices;
  struct View;

  [[nodiscard]] BlockIndices block_indices() const;
  [[nodiscard]] TargetPose target_pose(const double* const* blocks) const;
  [[nodiscard]] bool project_target(const double* const* blocks, View& view) const;
  template <class OfCorner>
  void put(const View& view,
           double* jacobian,
           std::size_t block,
           int columns,
           const OfCorner& of_corner) const;
  void put_target(const View& view, double** jacobians) const;
  void put_rest(const View& view, double** jacobians) const;

  Sighting sighting_;
  /// Derivative of each corner's z by warp_m.
  std::array<std::array<double, 3>, 4> bend_{};
  LensModel lens_;
  Parts parts_;
  Knots knots_;
  double line_ = 0.0;  ///< Rows of the sighting below the image's middle.
};

}  // namespace marey::calib
