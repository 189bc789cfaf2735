// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/marker_tracks.h"
#include "reconstruct/markers/fit_markers.h"

namespace marey::reconstruct {

/// The labels whose left and right are exchanged in a trial.
enum class SideExchange {
  kNone,
  kAll,    ///< All labels; or the axes of the file are left-handed.
  kTrunk,  ///< The trunk's labels; legs and arms are right.
  kLegs,   ///< The legs' labels, or those of a pelvis without a trunk above it.
  kArms,
};

/// Properties of a whole trial that its labels determine before any body is fitted.
struct TrialGeometry {
  SideExchange sides = SideExchange::kNone;
  /// Unit vector from the feet to the trunk, or from the hips to the head without feet,
  /// in the world: the mean over the frames. nullopt if the labels do not determine it.
  std::optional<glm::dvec3> body_up;
  /// The share of frames in which that direction is less than 45 degrees from the world's
  /// up.
  double upright_share = 1.0;
  /// Ratio of its distances between markers to those of the trials that agree with each
  /// other: the median over pairs of labels on one segment. nullopt for fewer than three
  /// pairs, and for a single trial.
  std::optional<double> scale;
  /// The trial that `scale` is relative to; the trial itself: 1.
  std::size_t scale_of = 0;
};

/// Computes the geometry of trials of one subject, in their order. Sides come from the
/// sign of the determinant between the places of the labels' landmarks on an average body
/// and the markers: a mirrored body has the other sign in all postures. If scales differ,
/// the reference is the trial that agrees with most others; if several do, the one with a
/// stature nearer to an adult's.
/// Deterministic. Cost: linear in the markers and in at most 100 frames of each trial;
/// quadratic in the markers of a segment and in the trials.
[[nodiscard]] std::vector<TrialGeometry> compare_trials(
    std::span<const MarkerTracks> trials, std::span<const NamedMarker> labels);

}  // namespace marey::reconstruct
