// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "core/marker_tracks.h"
#include "reconstruct/fit_markers.h"

namespace marey::reconstruct {

/// Where the hip joint centres lie in a pelvis whose spines are known.
struct HipRegression {
  double half_hip_width_m = 0.0;  ///< From the middle to either centre.
  /// From the middle of the hip joint centres to that of the anterior spines' markers, in
  /// the hips' frame (X left, Y up, Z forward). [m]
  glm::dvec3 anterior_in_hips{0.0};
  /// Likewise of the posterior spines' markers, or of one on the sacrum between them.
  glm::dvec3 posterior_in_hips{0.0};
  double half_anterior_width_m = 0.0;  ///< From the middle to either anterior marker.
};

/// Standard deviation per coordinate of a centre so found: what Harrington et al. found
/// in adults, near enough, together with markers' height above the bone. [m]
inline constexpr double kHipRegressionSigma_m = 0.007;

/// The hip joint centres after Harrington et al. (2007, "Prediction of the hip joint
/// centre in adults, children, and patients with cerebral palsy based on magnetic
/// resonance imaging", J. Biomech. 40, table 3: from pelvic depth and width alone).
/// `width_m` between the anterior spines' markers, `depth_m` from their middle to that of
/// the posterior ones; both markers' centres lie 7.5 mm off the bone in depth. The
/// pelvis is tilted as an average one that stands. Precondition: both above 0.
[[nodiscard]] HipRegression hips_from_spines(double width_m, double depth_m);

/// The same from trials: medians over the frames that show all of left and right anterior
/// spine, and both posterior spines or the sacrum. nullopt where no frame does.
[[nodiscard]] std::optional<HipRegression> hips_from_markers(
    std::span<const MarkerTracks> trials, std::span<const NamedMarker> labels);

}  // namespace marey::reconstruct
