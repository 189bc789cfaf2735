// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/progress.h"
#include "core/marker_tracks.h"
#include "reconstruct/tracks/repair_method.h"

namespace marey::reconstruct {

/// One gap of one marker: frames from `first` on, `frames` of them.
struct GapRepair {
  std::size_t marker = 0;
  std::size_t first = 0;
  std::size_t frames = 0;
  RepairMethod method = RepairMethod::kLeftEmpty;
  std::vector<std::size_t> carried_by;  ///< Its companions with the steadiest distances,
                                        ///< steadiest first.
  double median_sigma_m = 0.0;          ///< Over the filled samples; 0 if none.
  double worst_sigma_m = 0.0;
};

struct RepairOptions {
  /// Samples with a larger standard deviation per coordinate are left empty.
  double max_sigma_m = 0.1;
  /// Without other markers, a gap up to this length is bridged by the marker's own path.
  double max_spline_s = 0.2;
  /// The second pass uses the repairs of other gaps. At least 1; a third pass would
  /// change less than a tenth of a millimetre.
  int passes = 2;
  std::size_t threads = 1;  ///< 0: number of the machine's cores. Same result.
};

struct RepairedTracks {
  /// The given tracks with samples in the gaps: source kRepaired between two sights of
  /// the marker, kInferred before its first and after its last.
  MarkerTracks tracks;
  std::vector<GapRepair> gaps;  ///< By marker, then frame.
};

/// Fills the gaps of labelled markers from the trial alone.
/// Per gap, a Gaussian process (Rasmussen & Williams 2006, eq. 2.25-2.26) predicts the
/// marker's place in a frame that moves with its closest companions, those whose distance
/// to it varies least. Its covariance has a part that is linear in the places of all
/// other markers in that frame, as in principal component methods (Gloersen & Federolf
/// 2016), one for similar postures, and one in time, which makes the fill meet the
/// samples at the gap's edges. Two processes, one of the companions nearby and one of
/// many, are averaged. Markers at stable distances (bones) are then moved to these
/// distances as far as their sigmas allow. Long gaps are filled piece by piece, from the
/// markers that are seen in each, and the pieces are blended.
/// Existing samples are taken as right: find wrong ones first (find_marker_faults.h).
/// Deterministic for any number of threads. Cost: some 5 ms per gap and pass, plus the
/// distances between all markers at up to 1000 frames. Precondition: rate above 0.
[[nodiscard]] RepairedTracks repair_gaps(const MarkerTracks& tracks,
                                         const RepairOptions& options = {},
                                         const Progress& progress = {});

}  // namespace marey::reconstruct
