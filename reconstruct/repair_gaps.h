// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "core/marker_tracks.h"
#include "core/progress.h"

namespace marey::reconstruct {

/// What a gap was bridged with.
enum class RepairMethod {
  kCluster,    ///< Carried along by the markers that it moves with most stiffly.
  kStructure,  ///< And by how this trial's markers move together.
  kSpline,     ///< By its own path before and after: no other markers were of use.
  kLeftEmpty,  ///< It cannot be known well enough.
};

/// "cluster", "structure", "spline", "left-empty": the words of reports.
[[nodiscard]] std::string_view name(RepairMethod method);

/// One gap of one marker: frames from `first` on, `frames` of them.
struct GapRepair {
  std::size_t marker = 0;
  std::size_t first = 0;
  std::size_t frames = 0;
  RepairMethod method = RepairMethod::kLeftEmpty;
  std::vector<std::size_t> carried_by;  ///< Its stiffest companions, stiffest first.
  double median_sigma_m = 0.0;          ///< Of the samples that were filled; 0 if none.
  double worst_sigma_m = 0.0;
};

struct RepairOptions {
  /// Samples that are known no better are left empty: standard deviation per coordinate.
  double most_sigma_m = 0.1;
  /// Without other markers a gap of up to so long is bridged by the marker's own path.
  double longest_spline_s = 0.2;
  /// Other gaps' repairs help in the second pass. At least 1; what a third would change
  /// is less than a tenth of a millimetre.
  int passes = 2;
  std::size_t threads = 1;  ///< 0: as many as the machine has cores. Same result.
};

struct RepairedTracks {
  /// As given, with samples in the gaps: source kRepaired between two sights of the
  /// marker, kInferred before its first and after its last.
  MarkerTracks tracks;
  std::vector<GapRepair> gaps;  ///< By marker, then frame.
};

/// Fills the gaps of labelled markers from the trial alone.
///
/// Per gap, a Gaussian process (Rasmussen & Williams 2006, eq. 2.25-2.26) says where the
/// marker is within a frame that moves with its stiffest companions, those whose distance
/// to it varies least. Its covariance has a part that is linear in where all other
/// markers are in that frame, as in principal component methods (Gloersen & Federolf
/// 2016), one that remembers similar postures, and one in time, which makes the fill meet
/// the samples at the gap's edges. Two processes, of the companions nearby and of many,
/// are averaged. Markers at stable distances (bones) then pull each other to these as far
/// as their doubts allow. Long gaps are filled piece by piece, from those that are there
/// in each, and the pieces are blended.
///
/// Samples that are there are taken for right: find wrong ones first (check_tracks.h).
/// Deterministic whatever the number of threads. Cost: some 5 ms per gap and pass, plus
/// the distances between all markers at up to 1000 frames. Precondition: rate above 0.
[[nodiscard]] RepairedTracks repair_gaps(const MarkerTracks& tracks,
                                         const RepairOptions& options = {},
                                         const Progress& progress = {});

}  // namespace marey::reconstruct
