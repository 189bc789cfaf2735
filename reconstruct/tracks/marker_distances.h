// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: markers that move together.

#include <cstddef>
#include <vector>

#include "core/marker_tracks.h"

namespace marey::reconstruct {

/// Distances between markers, and their variances.
class MarkerDistances {
 public:
  struct Pair {
    double mean_m = 0.0;
    double variance_m2 = 0.0;
    int shared = 0;  ///< Number of sampled frames in which both were seen.
  };

  /// Samples up to `max_frames` frames, evenly chosen. Quadratic in markers.
  explicit MarkerDistances(const MarkerTracks& tracks, std::size_t max_frames = 1000);

  [[nodiscard]] const Pair& between(std::size_t a, std::size_t b) const {
    return pairs_[a * markers_ + b];
  }
  /// Returns the other markers, steadiest distance first, without any that was never seen
  /// together with it.
  [[nodiscard]] const std::vector<std::size_t>& companions(std::size_t marker) const {
    return companions_[marker];
  }

 private:
  std::size_t markers_;
  std::vector<Pair> pairs_;
  std::vector<std::vector<std::size_t>> companions_;
};

}  // namespace marey::reconstruct
