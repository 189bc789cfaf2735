// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: the joint refinement of fit_markers().

#include <vector>

#include "reconstruct/markers/marker_model.h"

namespace marey::reconstruct {

/// Expected place of a marker on its bone, with its uncertainty.
struct MarkerPlacePrior {
  Eigen::Vector3d p_in_bone{0.0, 0.0, 0.0};
  double sigma_m = 0.0;  ///< Per coordinate.
};

/// One instant of the bundle.
struct MarkerInstant {
  Posture posture;
  std::vector<SeenMarker> seen;
};

struct MarkerBundle {
  MarkerModel model;
  std::vector<MarkerPlacePrior> places;  ///< One per marker of the model: the prior.
  Lengths usual{};                       ///< Lengths of an average person: the prior.
  Lengths usual_sigma_m{};               ///< Standard deviation of lengths between
                                         ///< people.
  std::vector<MarkerInstant> instants;

  // Filled by adjust() with sigmas.
  Lengths length_sigma_m{};
  std::vector<double> place_sigma_m;  ///< Per marker and coordinate, root mean square.
};

/// Part of a marker's stray on skin that repeats with the posture, so that more frames do
/// not average it out: added to the measured stray of single markers. [m]
inline constexpr double kSkinBias_m = 0.006;

/// Minimizes the distances of the seen markers from their expected places over lengths,
/// places and postures (Ceres; Cauchy loss), with proportions, symmetry of left and
/// right, the places' priors and pose priors as soft terms. With `sigmas`, fills the
/// sigmas from the covariance. False if the solver finds no usable minimum. Precondition:
/// one place per marker, some instant with markers.
[[nodiscard]] bool adjust(MarkerBundle& bundle, int max_iterations, bool sigmas);

}  // namespace marey::reconstruct
