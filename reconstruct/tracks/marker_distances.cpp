// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tracks/marker_distances.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/quantile.h"

namespace marey::reconstruct {
namespace {

// The variance from few shared frames is unreliable: it is increased by (kPriorSpread_m *
// kPriorFrames / shared)^2.
constexpr double kPriorFrames = 5.0;
constexpr double kPriorSpread_m = 0.05;

// Ratio of a normal distribution's standard deviation to the median distance from the
// median.
constexpr double kSigmaOfMedian = 1.4826;
// Distances further off than this many spreads, and this far, belong to a wrong sample.
constexpr double kWild = 10.0;
constexpr double kNeverWild_m = 0.03;

}  // namespace

MarkerDistances::MarkerDistances(const MarkerTracks& tracks, std::size_t max_frames)
    : markers_(tracks.markers()), pairs_(markers_ * markers_), companions_(markers_) {
  const std::size_t frames = tracks.frames();
  const std::size_t looked_at = std::min(frames, max_frames);
  std::vector<double> apart_m;
  for (std::size_t a = 0; a < markers_; ++a) {
    for (std::size_t b = a + 1; b < markers_; ++b) {
      apart_m.clear();
      for (std::size_t i = 0; i < looked_at; ++i) {
        const std::size_t frame = i * frames / looked_at;
        const auto& at_a = tracks.at(frame, a);
        const auto& at_b = tracks.at(frame, b);
        if (at_a && at_b) {
          apart_m.push_back(glm::distance(at_a->p_in_world, at_b->p_in_world));
        }
      }
      if (apart_m.empty()) continue;
      const auto shared = static_cast<int>(apart_m.size());
      const double typical_m = median(apart_m);
      std::vector<double> off_m;
      for (const double distance_m : apart_m) {
        off_m.push_back(std::abs(distance_m - typical_m));
      }
      const double max_off_m = kWild * kSigmaOfMedian * median(off_m) + kNeverWild_m;
      double sum_m = 0.0;
      double sum_m2 = 0.0;
      int taken = 0;
      for (const double distance_m : apart_m) {
        const double more_m = distance_m - typical_m;
        if (std::abs(more_m) > max_off_m) continue;
        sum_m += more_m;
        sum_m2 += more_m * more_m;
        ++taken;
      }
      const double mean_m = sum_m / taken;
      const double variance_m2 = std::max(0.0, sum_m2 / taken - mean_m * mean_m);
      const double prior_m = kPriorSpread_m * kPriorFrames / shared;
      pairs_[a * markers_ + b] = {
          typical_m + mean_m, variance_m2 + prior_m * prior_m, shared};
      pairs_[b * markers_ + a] = pairs_[a * markers_ + b];
      companions_[a].push_back(b);
      companions_[b].push_back(a);
    }
  }
  for (std::size_t a = 0; a < markers_; ++a) {
    std::stable_sort(
        companions_[a].begin(), companions_[a].end(), [&](std::size_t b, std::size_t c) {
          return between(a, b).variance_m2 < between(a, c).variance_m2;
        });
  }
}

}  // namespace marey::reconstruct
