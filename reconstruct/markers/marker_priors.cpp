// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/marker_priors.h"

#include "reconstruct/clusters/sightings.h"

namespace marey::reconstruct {
namespace {

Eigen::Vector3d to_eigen(const glm::dvec3& p) {
  return {p.x, p.y, p.z};
}

/// Returns the priors of the spines of the pelvis, if it was measured across them.
std::optional<MarkerPlacePrior> on_measured_pelvis(
    const Landmark& landmark,
    double stature_m,
    const std::optional<HipRegression>& hips,
    const BodyConstants& frame) {
  if (!hips) return std::nullopt;
  const double side = landmark.p_in_segment_per_stature.x > 0.0   ? 1.0
                      : landmark.p_in_segment_per_stature.x < 0.0 ? -1.0
                                                                  : 0.0;
  glm::dvec3 p(0.0);
  if (landmark.name.ends_with("_asis")) {
    p = hips->anterior_in_hips;
    p.x = side * hips->half_anterior_width_m;
  } else if (landmark.name.ends_with("_psis") || landmark.name == "sacrum") {
    p = hips->posterior_in_hips;
    p.x = stature_m * landmark.p_in_segment_per_stature.x;
  } else {
    return std::nullopt;
  }
  p.y -= frame.hips_above_hip_centres_m;
  return MarkerPlacePrior{to_eigen(p), kHipRegressionSigma_m};
}

}  // namespace

MarkerPlacePrior landmark_prior(const Landmark& landmark,
                                double stature_m,
                                const Proportions& average,
                                const std::optional<HipRegression>& hips,
                                const BodyConstants& frame) {
  if (const auto measured = on_measured_pelvis(landmark, stature_m, hips, frame)) {
    return *measured;
  }
  glm::dvec3 p = stature_m * landmark.p_in_segment_per_stature;
  // Toes move with their foot.
  if (solved_segment(landmark.segment) != landmark.segment)
    p += average[landmark.segment];
  return {to_eigen(p), stature_m * landmark.sigma_per_stature};
}

}  // namespace marey::reconstruct
