// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: a body with markers, and the posture of one frame of it.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "reconstruct/posture_descent.h"

namespace marey::reconstruct {

/// A marker glued to a body.
struct ModelMarker {
  HumanBone bone{};
  Eigen::Vector3d p_in_bone{0.0, 0.0, 0.0};
  /// How far it strays from there, per coordinate: skin, wobble, noise. [m]
  double sigma_m = 0.01;
};

struct MarkerModel {
  Lengths lengths{};
  BodyFrame body;
  /// Wrists' markers show how far a forearm is turned.
  TwistHabits twists{0.15, 1.2, 0.08};
  std::vector<ModelMarker> markers;
};

/// A marker of the model, seen in this frame.
struct SeenMarker {
  std::size_t marker = 0;
  Eigen::Vector3d p_in_world{0.0, 0.0, 0.0};
  double sigma_m = 0.0;  ///< Of the sample itself, beside the marker's own.
};

/// Cauchy's loss starts to doubt a marker that is this many sigmas off.
inline constexpr double kDoubtfulSigmas = 3.0;

struct FrameLimits : DescentLimits {
  /// Markers stray this many times farther than the model says: a start that is far off
  /// has to be brought near before any marker can be told from a wrong one.
  double sigma_scale = 1.0;
  /// Of the habits' weight.
  double habit_share = 1.0;
};

/// Levenberg and Marquardt's method on one frame: markers, habits, and what is known
/// beside. Storage is fixed: no allocation. Borrows the model.
class MarkerFrameSolver {
 public:
  explicit MarkerFrameSolver(const MarkerModel& model) : model_(&model) {}

  /// Moves `posture` to the least cost nearby; returns that cost. `prior` may be null.
  /// Some 40 microseconds per iteration with 50 markers.
  double solve(std::span<const SeenMarker> seen,
               const PosturePrior* prior,
               Posture& posture,
               const FrameLimits& limits = {});

  /// Iterations of the last solve().
  [[nodiscard]] int iterations() const { return descent_.iterations(); }
  /// Of the last solve(), at the posture from which its last step was made.
  [[nodiscard]] const ArrowFactor& factor() const { return descent_.factor(); }
  /// The posture given, unfolded.
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
