// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/track_tag_slip.h"

#include <algorithm>
#include <cmath>

namespace marey::reconstruct {
namespace {

// Prior of the slip of tags on skin, and its weight in sightings. A segment's own slip
// has a prior of the same weight, the mean of all segments.
constexpr double kPriorSlip_m = 0.0005;
constexpr double kSlipPriorSightings = 20.0;
// Time constant; the slip changes when the subject starts or stops moving.
constexpr double kMemory_s = 1.0;
// Upper bound, larger than the slip of clothes. [m]
constexpr double kMaxSlip_m = 0.03;

double within_reason(double variance_m2) {
  return std::clamp(variance_m2, 0.0, kMaxSlip_m * kMaxSlip_m);
}

}  // namespace

SlipTracker::SlipTracker() {
  all_.variance_m2 = kPriorSlip_m * kPriorSlip_m;
  for (Sums& own : own_) own = all_;
  sigmas_m_.fill(kPriorSlip_m);
}

void SlipTracker::update(std::span<const TagFrameSolver::SlipScore> scores,
                         double since_s) {
  const double kept = std::exp(-since_s / kMemory_s);
  TagFrameSolver::SlipScore sum;
  for (const TagFrameSolver::SlipScore& one : scores) {
    sum.excess += one.excess;
    sum.information += one.information;
    sum.count += one.count;
  }
  if (!(sum.information > 0.0) || !std::isfinite(sum.excess)) return;
  all_.information = kept * all_.information + sum.information;
  all_.count = kept * all_.count + sum.count;
  const double prior = kSlipPriorSightings * all_.information / all_.count;
  all_.variance_m2 =
      within_reason(all_.variance_m2 + sum.excess / (all_.information + prior));
  for (std::size_t b = 0; b < own_.size(); ++b) {
    Sums& own = own_[b];
    own.information = kept * own.information + scores[b].information;
    const double pull =
        (1.0 - kept) * prior * (all_.variance_m2 - own.variance_m2) + scores[b].excess;
    own.variance_m2 = within_reason(own.variance_m2 + pull / (own.information + prior));
    sigmas_m_[b] = std::sqrt(own.variance_m2);
  }
}

}  // namespace marey::reconstruct
