// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: minimization of the cost of one posture.

#include <algorithm>
#include <array>
#include <utility>

#include "reconstruct/posture/posture_equations.h"

namespace marey::reconstruct {

struct DescentLimits {
  int iterations = 20;
  /// A step smaller than this is the last one: [m] and [rad]. Its error is of the size of
  /// its square.
  double last_step = 3e-3;
};

/// Limits of the solution of one frame.
struct FrameLimits : DescentLimits {
  /// Factor on the observations' sigmas: at a start far from the solution, outliers are
  /// indistinguishable from inliers until the posture is close.
  double sigma_scale = 1.0;
  /// Share of the pose priors' weight.
  double prior_share = 1.0;
};

/// Levenberg-Marquardt's method on one posture. Storage is fixed: no allocation.
class PostureDescent {
 public:
  /// Moves `posture` to the nearest minimum of the cost; returns that cost.
  /// `evaluate(posture, equations)` fills the equations at a posture.
  template <class Evaluate>
  double run(const Evaluate& evaluate, const DescentLimits& limits, Posture& posture);

  /// Iterations of the last run().
  [[nodiscard]] int iterations() const { return iterations_; }
  /// Factored equations of the last run(), at the posture before its last step.
  [[nodiscard]] const ArrowFactor& factor() const { return factor_; }

 private:
  // Damping below this does not shorten a step.
  static constexpr double kNearlyFree = 1e-3;

  /// Equations at the posture and at the candidate; their roles are exchanged.
  std::array<PostureEquations, 2> equations_;
  ArrowFactor factor_;
  int iterations_ = 0;
};

template <class Evaluate>
double PostureDescent::run(const Evaluate& evaluate,
                           const DescentLimits& limits,
                           Posture& posture) {
  PostureEquations* now = &equations_[0];
  PostureEquations* next = &equations_[1];
  evaluate(posture, *now);
  double damping = 0.0;
  PostureVector step;
  for (iterations_ = 1; iterations_ <= limits.iterations; ++iterations_) {
    if (!factor_.factor(now->hessian, damping)) {
      damping = std::max(1e-6, 10.0 * damping);
      continue;
    }
    factor_.step(now->gradient, step);
    const double largest = step.cwiseAbs().maxCoeff();
    Posture moved = posture;
    move(moved, step);
    // A damped step can be small because of the damping.
    if (largest < limits.last_step && damping < kNearlyFree) {
      // So near the minimum, the quadratic approximation is exact enough.
      now->cost += 0.5 * now->gradient.dot(step);
      posture = moved;
      break;
    }
    evaluate(moved, *next);
    if (next->cost < now->cost) {
      posture = moved;
      std::swap(now, next);
      damping = damping < 1e-5 ? 0.0 : 0.1 * damping;
    } else {
      damping = std::max(1e-3, 10.0 * damping);
      if (damping > 1e8) break;
    }
  }
  iterations_ = std::min(iterations_, limits.iterations);
  // The covariance of the posture comes from the equations without damping.
  if (damping > 0.0 && !factor_.factor(now->hessian, 0.0)) {
    (void)factor_.factor(now->hessian, damping);
  }
  return now->cost;
}

}  // namespace marey::reconstruct
