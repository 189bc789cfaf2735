// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/marker_tracks.h"
#include "reconstruct/markers/fit_markers.h"
#include "reconstruct/markers/solve_markers.h"

namespace marey::reconstruct {

/// Faults of a label, or of a marker under it.
enum class LabelFault {
  kOffLandmark,  ///< Its marker is at an impossible distance from its landmark.
  kMoved,        ///< It moves with a segment far from the one it is named for.
  kLeftOut,      ///< It moves with no segment.
  kStrays,       ///< In one trial it is not at its place.
  kExchanged,    ///< Exchanged with another label, in one trial or in all of them.
};

/// Returns "off-landmark", "moved", "left-out", "strays", "exchanged": the words of
/// reports.
[[nodiscard]] std::string_view name(LabelFault fault);

/// A label that does not match its marker, as data: what to exchange, in which trial.
/// Callers make the Finding for the user.
struct FaultyLabel {
  LabelFault fault{};
  std::string label;
  std::string other;  ///< The other label, for kExchanged.
  /// Position among the trials; nullopt: in all of them.
  std::optional<std::size_t> trial;
  /// If two trials differ, either can be wrong: the other one.
  std::optional<std::size_t> or_trial;
  double off_m = 0.0;        ///< Distance from its expected place.
  double exchanged_m = 0.0;  ///< For kExchanged: that distance after the exchange.
};

/// A trial and its solution.
struct CheckedTrial {
  const MarkerTracks* tracks = nullptr;
  const SolvedMarkers* solved = nullptr;  ///< nullptr: not solved.
};

/// Returns the distance between a marker and the place of its landmark on a body, divided
/// by the standard deviation of places between people: per coordinate, root mean square.
/// nullopt if the landmark has no exact place on its segment, or if the marker was moved
/// to another segment.
[[nodiscard]] std::optional<double> landmark_distance_sigmas(const PlacedMarker& marker,
                                                             const Landmark& landmark,
                                                             double stature_m);

/// Finds labels in a fit whose markers do not match their names.
[[nodiscard]] std::vector<FaultyLabel> assess_fit_labels(
    const MarkersFit& fit, std::span<const NamedMarker> labels);

/// Finds labels that are wrong in single trials. Each marker's place on its segment is
/// compared with its place in the other trials, or in the fit if there is no other. A
/// marker that is off by more than its noise is tested for an exchange with every other
/// one. An exchange is reported once, for the trial that differs most.
/// Deterministic. Cost: linear in the markers and in at most 200 frames of each trial.
/// Precondition: every solution is of `body` and of its tracks.
[[nodiscard]] std::vector<FaultyLabel> assess_trial_labels(
    const Body& body,
    std::span<const NamedMarker> labels,
    std::span<const CheckedTrial> trials);

}  // namespace marey::reconstruct
