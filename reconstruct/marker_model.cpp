// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/marker_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace marey::reconstruct {
namespace {

// Of the damping: so little does not hold a step back.
constexpr double kNearlyFree = 1e-3;

}  // namespace

const UnfoldedPosture& MarkerFrameSolver::unfold(const Posture& posture) {
  unfolded_.unfold(posture, model_->lengths, model_->body);
  return unfolded_;
}

void MarkerFrameSolver::evaluate(std::span<const SeenMarker> seen,
                                 const PosturePrior* prior,
                                 const Posture& posture,
                                 const FrameLimits& limits,
                                 PostureEquations& out) {
  constexpr double kC2 = kDoubtfulSigmas * kDoubtfulSigmas;
  unfold(posture);
  out.clear();
  for (const SeenMarker& sample : seen) {
    const ModelMarker& marker = model_->markers[sample.marker];
    const Eigen::Vector3d p = unfolded_.point(marker.bone, marker.p_in_bone);
    const Eigen::Vector3d off = p - sample.p_in_world;
    const double information =
        1.0 / (limits.sigma_scale * limits.sigma_scale *
               (marker.sigma_m * marker.sigma_m + sample.sigma_m * sample.sigma_m));
    const double squared = information * off.squaredNorm();
    out.cost += 0.5 * kC2 * std::log1p(squared / kC2);
    unfolded_.derivative(marker.bone, p, derivative_);
    out.add(derivative_, off, information / (1.0 + squared / kC2));
  }
  out.add_habits(posture, unfolded_, model_->twists, limits.habit_share);
  if (prior) out.add_prior(posture, model_->lengths, *prior);
}

double MarkerFrameSolver::solve(std::span<const SeenMarker> seen,
                                const PosturePrior* prior,
                                Posture& posture,
                                const FrameLimits& limits) {
  PostureEquations* now = &equations_[0];
  PostureEquations* next = &equations_[1];
  evaluate(seen, prior, posture, limits, *now);
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
    // A damped step is small because it is held back.
    if (largest < limits.last_step && damping < kNearlyFree) {
      // So near the least cost that the quadratic it was computed from is right.
      now->cost += 0.5 * now->gradient.dot(step);
      posture = moved;
      break;
    }
    evaluate(seen, prior, moved, limits, *next);
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
  // What is known of the posture is told by the equations alone.
  if (damping > 0.0 && !factor_.factor(now->hessian, 0.0)) {
    (void)factor_.factor(now->hessian, damping);
  }
  return now->cost;
}

}  // namespace marey::reconstruct
