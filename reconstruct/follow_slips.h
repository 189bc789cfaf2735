// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to reconstruct: how far tags slip on a body, followed while it moves. What
// tag_slip.h finds of a whole trial.

#include "reconstruct/tag_model.h"

namespace marey::reconstruct {

/// Follows each segment's slip: restricted maximum likelihood, a step of scoring per
/// frame, the past forgotten within seconds. Cost: some microseconds per sighting.
class FollowedSlips {
 public:
  FollowedSlips();

  /// What one frame's residuals say, `since_s` after the one before.
  void update(std::span<const TagFrameSolver::SlipScore> told, double since_s);

  /// Standard deviations. [m]
  [[nodiscard]] const SegmentSlips& sigmas_m() const { return sigmas_m_; }

 private:
  struct Sums {
    double variance_m2 = 0.0;
    double information = 0.0;  ///< On it, of the past that counts. [1/m^4]
    double count = 0.0;        ///< Sightings, likewise.
  };
  std::array<Sums, kHumanBoneCount> own_{};
  Sums all_;
  SegmentSlips sigmas_m_{};
};

}  // namespace marey::reconstruct
