// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "core/marker_tracks.h"

namespace marey::reconstruct {

/// What can be wrong with a sample that is there.
enum class TrackFault {
  kNoNumber,  ///< Not a number, or further away than any room is wide.
  kFrozen,    ///< The marker stands still to the last digit while its body moves on.
  kSwapped,   ///< Two markers bear each other's names.
  kGhost,     ///< Something else, between two gaps: a reflection, another marker.
  kJump,      ///< Off its place without a gap before and after.
};

/// "no-number", "frozen", "swapped", "ghost", "jump": the words of reports.
[[nodiscard]] std::string_view name(TrackFault fault);

/// A fault of one marker: `frames` frames from `first` on.
struct TrackFinding {
  TrackFault fault{};
  std::size_t marker = 0;
  std::optional<std::size_t> other;  ///< With which it was swapped; told once.
  std::size_t first = 0;
  std::size_t frames = 0;
  double off_m = 0.0;  ///< Median distance from where the others have it; 0 of kNoNumber.
};

struct CheckedTracks {
  /// As given; swapped samples are exchanged, other wrong ones are taken out.
  MarkerTracks tracks;
  std::vector<TrackFinding> findings;  ///< By first frame.
};

/// Finds samples that cannot be right, by the marker's distances to the companions whose
/// distances are steadiest: a run of samples (between gaps, and jumps) is wrong when most
/// of these are off by far more than they ever are, at least 25 mm. Markers with fewer
/// than three companions are looked at for jumps and freezing alone.
///
/// Deterministic. Cost: linear in frames, quadratic in markers for the distances, linear
/// for the rest. Precondition: rate above 0.
[[nodiscard]] CheckedTracks check_tracks(const MarkerTracks& tracks);

}  // namespace marey::reconstruct
