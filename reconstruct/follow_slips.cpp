// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/follow_slips.h"

#include <algorithm>
#include <cmath>

namespace marey::reconstruct {
namespace {

// How far tags slip on skin, where nothing else is known; and what that is worth, in
// sightings. A segment's own slip is taken for that of all, as much as so many would say.
constexpr double kUsualSlip_m = 0.0005;
constexpr double kPriorSightings = 20.0;
// Skin that wobbles stops to when its owner does.
constexpr double kMemory_s = 1.0;
// More than clothes do. [m]
constexpr double kMostSlip_m = 0.03;

double within_reason(double variance_m2) {
  return std::clamp(variance_m2, 0.0, kMostSlip_m * kMostSlip_m);
}

}  // namespace

FollowedSlips::FollowedSlips() {
  all_.variance_m2 = kUsualSlip_m * kUsualSlip_m;
  for (Sums& own : own_) own = all_;
  sigmas_m_.fill(kUsualSlip_m);
}

void FollowedSlips::update(std::span<const TagFrameSolver::SlipScore> told,
                           double since_s) {
  const double kept = std::exp(-since_s / kMemory_s);
  TagFrameSolver::SlipScore sum;
  for (const TagFrameSolver::SlipScore& one : told) {
    sum.excess += one.excess;
    sum.information += one.information;
    sum.count += one.count;
  }
  if (!(sum.information > 0.0) || !std::isfinite(sum.excess)) return;
  all_.information = kept * all_.information + sum.information;
  all_.count = kept * all_.count + sum.count;
  const double prior = kPriorSightings * all_.information / all_.count;
  all_.variance_m2 =
      within_reason(all_.variance_m2 + sum.excess / (all_.information + prior));
  for (std::size_t b = 0; b < own_.size(); ++b) {
    Sums& own = own_[b];
    own.information = kept * own.information + told[b].information;
    const double pull =
        (1.0 - kept) * prior * (all_.variance_m2 - own.variance_m2) + told[b].excess;
    own.variance_m2 = within_reason(own.variance_m2 + pull / (own.information + prior));
    sigmas_m_[b] = std::sqrt(own.variance_m2);
  }
}

}  // namespace marey::reconstruct
