// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the joint refinement behind fit_markers().

#include <vector>

#include "reconstruct/marker_model.h"

namespace marey::reconstruct {

/// Where a marker should be on its bone, give or take.
struct PlaceBelief {
  Eigen::Vector3d p_in_bone{0.0, 0.0, 0.0};
  double sigma_m = 0.0;  ///< Per coordinate.
};

/// One instant that the bundle looks at.
struct MarkerInstant {
  Posture posture;
  std::vector<SeenMarker> seen;
};

struct MarkerBundle {
  MarkerModel model;
  std::vector<PlaceBelief> places;  ///< One per marker of the model: the prior.
  Lengths usual{};                  ///< Of an average person: the prior.
  Lengths usual_sigma_m{};          ///< How far people differ from it.
  std::vector<MarkerInstant> instants;

  // Filled by adjust() with sigmas.
  Lengths length_sigma_m{};
  std::vector<double> place_sigma_m;  ///< Per marker and coordinate, root mean square.
};

/// How far a marker on skin strays in ways that repeat with the posture, so that more
/// frames do not average it out: added to what single markers are seen to stray. [m]
inline constexpr double kSkinBias_m = 0.006;

/// Moves lengths, places and postures to the least distance of the markers seen from
/// where they should be (Ceres; Cauchy's loss), with proportions, left and right alike,
/// the places' beliefs and human habits as soft terms. With `sigmas`, fills the sigmas
/// from the covariance. False when the solver finds no usable minimum.
/// Precondition: one place per marker, some instant with markers.
[[nodiscard]] bool adjust(MarkerBundle& bundle, int max_iterations, bool sigmas);

}  // namespace marey::reconstruct
