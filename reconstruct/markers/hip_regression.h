// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: hip joint centres from pelvis landmarks.

#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "core/marker_tracks.h"
#include "reconstruct/markers/markers_fit.h"

namespace marey::reconstruct {

/// Places of the hip joint centres in a pelvis with known spines.
struct HipRegression {
  double half_hip_width_m = 0.0;  ///< From the middle to either centre.
  /// From the middle of the hip joint centres to that of the anterior spines' markers, in
  /// the hips' frame (X left, Y up, Z forward). [m]
  glm::dvec3 anterior_in_hips{0.0};
  /// The same for the posterior spines' markers, or for one on the sacrum between them.
  glm::dvec3 posterior_in_hips{0.0};
  double half_anterior_width_m = 0.0;  ///< From the middle to either anterior marker.
};

/// Standard deviation per coordinate of such a centre: approximately that of Harrington
/// et al. in adults, combined with markers' height above the bone. [m]
inline constexpr double kHipRegressionSigma_m = 0.007;

/// Computes the hip joint centres after Harrington et al. (2007, "Prediction of the hip
/// joint centre in adults, children, and patients with cerebral palsy based on magnetic
/// resonance imaging", J. Biomech. 40, table 3: from pelvic depth and width alone).
/// `width_m` is the distance between the anterior spines' markers, `depth_m` that from
/// their middle to the middle of the posterior ones; both markers' centres lie 7.5 mm off
/// the bone in depth. The pelvis has the tilt of an average standing one. Precondition:
/// both above 0.
[[nodiscard]] HipRegression hips_from_spines(double width_m, double depth_m);

/// Computes the same from trials: medians over the frames that show left and right
/// anterior spine, and both posterior spines or the sacrum. nullopt if no frame shows
/// them.
[[nodiscard]] std::optional<HipRegression> hips_from_markers(
    std::span<const MarkerTracks> trials, std::span<const NamedMarker> labels);

}  // namespace marey::reconstruct
