// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/marker_model.h"

#include <cmath>

#include "reconstruct/markers/marker_loss.h"

namespace marey::reconstruct {
const UnfoldedPosture& MarkerFrameSolver::unfold(const Posture& posture) {
  unfolded_.unfold(posture, model_->lengths, model_->body);
  return unfolded_;
}

void MarkerFrameSolver::evaluate(std::span<const SeenMarker> seen,
                                 const PosturePrior* prior,
                                 const Posture& posture,
                                 const FrameLimits& limits,
                                 PostureEquations& out) {
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
    out.cost += marker_cost(squared);
    unfolded_.derivative(marker.bone, p, derivative_);
    out.add(derivative_, off, marker_weight(information, squared));
  }
  out.add_posture_priors(posture, unfolded_, model_->twists, limits.prior_share);
  if (prior) out.add_prior(posture, model_->lengths, *prior);
}

double MarkerFrameSolver::solve(std::span<const SeenMarker> seen,
                                const PosturePrior* prior,
                                Posture& posture,
                                const FrameLimits& limits) {
  return descent_.run(
      [&](const Posture& at, PostureEquations& out) {
        evaluate(seen, prior, at, limits, out);
      },
      limits,
      posture);
}

}  // namespace marey::reconstruct
