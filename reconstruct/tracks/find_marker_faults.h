// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "core/marker_tracks.h"

namespace marey::reconstruct {

/// Faults of a sample.
enum class TrackFault {
  kNoNumber,   ///< Not a number, or outside of any capture volume.
  kFrozen,     ///< The marker is exactly still while its body moves.
  kExchanged,  ///< Two markers have each other's names.
  kGhost,      ///< Another object between two gaps: a reflection, another marker.
  kJump,       ///< Off its place without a gap before and after.
};

/// Returns "no-number", "frozen", "swapped" (kExchanged), "ghost", "jump": the words of
/// reports.
[[nodiscard]] std::string_view name(TrackFault fault);

/// A fault of one marker, `frames` frames from `first` on, as data: repair acts on it,
/// and reports count it.
struct FaultySamples {
  TrackFault fault{};
  std::size_t marker = 0;
  std::optional<std::size_t>
      other;  ///< Marker that it was exchanged with; reported once.
  std::size_t first = 0;
  std::size_t frames = 0;
  double off_m = 0.0;  ///< Median distance from the place expected by the others; 0 for
                       ///< kNoNumber.
};

struct CheckedTracks {
  /// The given tracks; samples of exchanged markers are put back, other wrong ones are
  /// removed.
  MarkerTracks tracks;
  std::vector<FaultySamples> findings;  ///< By first frame.
};

/// Finds wrong samples by the marker's distances to the companions with the steadiest
/// distances: a run of samples (between gaps, and jumps) is wrong if most of these are
/// off by far more than in the rest of the trial, at least 25 mm. Markers with fewer than
/// three companions are checked for jumps and freezing alone.
/// Deterministic. Cost: linear in frames, quadratic in markers for the distances, linear
/// for the rest. Precondition: rate above 0.
[[nodiscard]] CheckedTracks find_marker_faults(const MarkerTracks& tracks);

}  // namespace marey::reconstruct
