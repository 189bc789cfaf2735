// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: running estimate of the slip of tags on a body;
// soft_tissue_noise.h estimates it from a whole trial.

#include "reconstruct/tags/tag_model.h"

namespace marey::reconstruct {

/// Tracks each segment's slip: restricted maximum likelihood, one scoring step per frame,
/// with exponential decay of the past within seconds. Cost: some microseconds per
/// sighting.
class SlipTracker {
 public:
  SlipTracker();

  /// Updates the estimate with one frame's scores, `since_s` after the previous one.
  void update(std::span<const TagFrameSolver::SlipScore> scores, double since_s);

  /// Standard deviations. [m]
  [[nodiscard]] const SegmentSlips& sigmas_m() const { return sigmas_m_; }

 private:
  struct Sums {
    double variance_m2 = 0.0;
    double information = 0.0;  ///< Decayed information on the variance. [1/m^4]
    double count = 0.0;        ///< Decayed number of sightings.
  };
  std::array<Sums, kHumanBoneCount> own_{};
  Sums all_;
  SegmentSlips sigmas_m_{};
};

}  // namespace marey::reconstruct
