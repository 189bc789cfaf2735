// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: a RigModel as a Ceres problem.

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/Dense>
#include <ceres/ceres.h>

#include "calib/bundle/refine_options.h"
#include "calib/model/rig_model.h"
#include "calib/model/sighting_cost.h"

namespace marey::calib {

/// Holds the parameters that a solver moves. Outliers are excluded.
class BundleProblem {
 public:
  /// A sighting of a smooth target is excluded if the target lacks knots around its time.
  BundleProblem(const RigModel& model, const RefineOptions& options, bool robust);

  [[nodiscard]] bool solve();
  void write_back(RigModel& model) const;

  /// Returns the inverse of the normal matrix at the current parameters, with poses of
  /// targets eliminated first. Returns nullopt if a camera is unconstrained.
  [[nodiscard]] std::optional<RigUncertainty> uncertainty();

 private:
  struct CameraBlock {
    std::array<double, Intrinsics::kParameterCount> lens{};
    PoseBlock pose{};
    ClockBlock clock{};
    std::array<double, 2> shrinkage{};
  };
  struct TargetBlock {
    std::map<int, PoseBlock> poses;
    std::vector<PieceBlock> pieces;
    std::array<double, 3> warp{};
  };

  void add_sighting(const RigModel& model, const Sighting& sighting, bool robust);
  void add_motion_priors(const RigModel& model, const RefineOptions& options);
  void add_priors(const RigModel& model);
  void set_manifolds(const RigModel& model, const RefineOptions& options);
  void set_clocks(const RigModel& model, const RefineOptions& options);
  [[nodiscard]] bool moves(const double* block) const;
  [[nodiscard]] std::vector<double*> shared_blocks();
  [[nodiscard]] std::vector<double*> pose_blocks();
  /// Returns the column of each parameter of RigCovariance; -1 if it is held. `first`:
  /// the columns at which blocks begin.
  [[nodiscard]] std::vector<int> columns_of_cameras(
      const std::map<const double*, int>& first) const;
  /// Returns the sigmas of camera `c`, whose clock begins at that column.
  [[nodiscard]] ClockSigma clock_sigma(std::size_t c,
                                       int first,
                                       const Eigen::MatrixXd& covariance) const;
  /// Returns RigUncertainty::sigma_factor from the cost of that many residuals.
  [[nodiscard]] double sigma_factor(double cost, int numbers) const;

  std::vector<CameraBlock> cameras_;
  std::vector<TargetBlock> targets_;
  bool shrinks_ = false;
  double tolerance_ = 1e-9;  ///< Relative tolerance of the cost.
  int max_iterations_ = 100;
  std::function<void()> on_iteration_;
  ceres::Problem problem_;
  int residuals_ = 0;
};

}  // namespace marey::calib
