// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/marker_tracks.h"
#include "reconstruct/fit_markers.h"

namespace marey::reconstruct {

/// The labels whose left and right are exchanged in a trial.
enum class ExchangedSides {
  kNone,
  kAll,    ///< All labels; or the axes of the file are left-handed.
  kTrunk,  ///< Those of the trunk; legs and arms are right.
  kLegs,   ///< Those of the legs, or those of a pelvis that has no trunk above it.
  kArms,
};

/// What the labels show of a whole trial before any body is fitted.
struct TrialGeometry {
  ExchangedSides sides = ExchangedSides::kNone;
  /// Unit vector from the feet to the trunk, or from the hips to the head without feet,
  /// in the world: the mean over the frames. nullopt where the labels do not show it.
  std::optional<glm::dvec3> body_up;
  /// The share of frames in which that direction is less than 45 degrees from the
  /// world's up.
  double upright_share = 1.0;
  /// Its distances between markers over those of the trials that agree with each other:
  /// the median over pairs of labels on one segment. nullopt of fewer than three pairs,
  /// and of a single trial.
  std::optional<double> scale;
  /// The trial that `scale` is relative to; the trial itself: 1.
  std::size_t scale_of = 0;
};

/// Computes the geometry of trials of one subject, in their order. Sides come from the
/// sign of the determinant between the places of the labels' landmarks on an average body
/// and the markers: a mirrored body has the other sign, however it moves. Of trials whose
/// scales differ the one is taken for right that agrees with most others, and of as many
/// the one with a stature nearer to an adult's.
///
/// Deterministic. Cost: linear in the markers and in at most 100 frames of each trial;
/// quadratic in the markers of a segment and in the trials.
[[nodiscard]] std::vector<TrialGeometry> compare_trials(
    std::span<const MarkerTracks> trials, std::span<const NamedMarker> labels);

}  // namespace marey::reconstruct
