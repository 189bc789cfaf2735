// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: which markers move together.

#include <cstddef>
#include <vector>

#include "core/marker_tracks.h"

namespace marey::reconstruct {

/// How far markers are from each other, and how steadily so.
class MarkerDistances {
 public:
  struct Pair {
    double mean_m = 0.0;
    double variance_m2 = 0.0;
    int shared = 0;  ///< Frames, of those looked at, in which both were seen.
  };

  /// Looks at up to `most_frames` frames, evenly chosen. Quadratic in markers.
  explicit MarkerDistances(const MarkerTracks& tracks, std::size_t most_frames = 1000);

  [[nodiscard]] const Pair& between(std::size_t a, std::size_t b) const {
    return pairs_[a * markers_ + b];
  }
  /// The others, stiffest first; those that were never seen together with it left out.
  [[nodiscard]] const std::vector<std::size_t>& companions(std::size_t marker) const {
    return companions_[marker];
  }

 private:
  std::size_t markers_;
  std::vector<Pair> pairs_;
  std::vector<std::vector<std::size_t>> companions_;
};

}  // namespace marey::reconstruct
