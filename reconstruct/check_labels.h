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
#include "reconstruct/fit_markers.h"
#include "reconstruct/solve_markers.h"

namespace marey::reconstruct {

/// What can be wrong with a label, or with a marker under it.
enum class LabelFault {
  kOffLandmark,  ///< Its marker is where its landmark can be on nobody.
  kMoved,        ///< It moves with a segment far from the one it is named for.
  kLeftOut,      ///< It moves with no segment.
  kStrays,       ///< In one trial it does not stay at its place.
  kExchanged,    ///< With another label, in one trial or in all of them.
};

/// "off-landmark", "moved", "left-out", "strays", "exchanged": the words of reports.
[[nodiscard]] std::string_view name(LabelFault fault);

struct LabelFinding {
  LabelFault fault{};
  std::string label;
  std::string other;  ///< Of kExchanged.
  /// Position among the trials; nullopt: in all of them.
  std::optional<std::size_t> trial;
  /// Of two trials that differ either may be wrong: the other one.
  std::optional<std::size_t> or_trial;
  double off_m = 0.0;        ///< Distance from where it should be.
  double exchanged_m = 0.0;  ///< Of kExchanged: the same after the exchange.
};

/// A trial and its solution.
struct CheckedTrial {
  const MarkerTracks* tracks = nullptr;
  const SolvedMarkers* solved = nullptr;  ///< nullptr: not solved.
};

/// Returns how far a marker is from the place of its landmark on a body, over how far
/// places differ between people: per coordinate, root mean square. nullopt where the
/// landmark is somewhere on a segment only, or the marker was moved to another segment.
[[nodiscard]] std::optional<double> landmark_distance_sigmas(const PlacedMarker& marker,
                                                             const Landmark& landmark,
                                                             double stature_m);

/// Finds labels whose markers cannot be what they are called, in a fit.
[[nodiscard]] std::vector<LabelFinding> check_fit(const MarkersFit& fit,
                                                  std::span<const NamedMarker> labels);

/// Finds labels that are wrong in single trials: each marker's place on its segment is
/// compared with its place in the other trials, or in the fit where there is none; a
/// marker that is off by more than its noise is tested for an exchange with every other
/// one. An exchange is reported once, as of the trial that differs from most.
///
/// Deterministic. Cost: linear in the markers and in at most 200 frames of each trial.
/// Precondition: every solution is of `body` and of its tracks.
[[nodiscard]] std::vector<LabelFinding> check_trials(
    const Body& body,
    std::span<const NamedMarker> labels,
    std::span<const CheckedTrial> trials);

}  // namespace marey::reconstruct
