// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: a body with markers, and a solver of the posture of one frame
// of it.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "reconstruct/posture/posture_descent.h"

namespace marey::reconstruct {

/// A marker fixed to a body.
struct ModelMarker {
  HumanBone bone{};
  Eigen::Vector3d p_in_bone{0.0, 0.0, 0.0};
  /// Standard deviation of its stray from there, per coordinate: skin, wobble, noise. [m]
  double sigma_m = 0.01;
};

struct MarkerModel {
  Lengths lengths{};
  BodyConstants body;
  /// Markers on wrists measure the rotation of a forearm.
  TwistPriors twists{0.15, 1.2, 0.08};
  std::vector<ModelMarker> markers;
};

/// A marker of the model, seen in this frame.
struct SeenMarker {
  std::size_t marker = 0;
  Eigen::Vector3d p_in_world{0.0, 0.0, 0.0};
  double sigma_m = 0.0;  ///< Sample's own sigma, in addition to the marker's.
};

/// Levenberg-Marquardt's method on one frame: markers, pose priors and a prior of the
/// frame. Storage is fixed: no allocation. Borrows the model.
class MarkerFrameSolver {
 public:
  explicit MarkerFrameSolver(const MarkerModel& model) : model_(&model) {}

  /// Moves `posture` to the nearest minimum of the cost; returns that cost. `prior` may
  /// be null. Some 40 microseconds per iteration with 50 markers.
  double solve(std::span<const SeenMarker> seen,
               const PosturePrior* prior,
               Posture& posture,
               const FrameLimits& limits = {});

  /// Iterations of the last solve().
  [[nodiscard]] int iterations() const { return descent_.iterations(); }
  /// Factored equations of the last solve(), at the posture before its last step.
  [[nodiscard]] const ArrowFactor& factor() const { return descent_.factor(); }
  /// Computes the bones' frames of a posture.
  const UnfoldedPosture& unfold(const Posture& posture);

 private:
  void evaluate(std::span<const SeenMarker> seen,
                const PosturePrior* prior,
                const Posture& posture,
                const FrameLimits& limits,
                PostureEquations& out);

  const MarkerModel* model_;
  UnfoldedPosture unfolded_;
  SparseDerivative derivative_;
  PostureDescent descent_;
};

}  // namespace marey::reconstruct
