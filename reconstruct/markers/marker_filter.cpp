// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/marker_filter.h"

#include <cmath>

namespace marey::reconstruct {
namespace {

// The body is lost if this share of the markers is off by this many sigmas.
constexpr double kLostSigmas = 6.0;
constexpr double kLostShare = 0.25;
// Frames between two searches for a lost body.
constexpr int kFramesBetweenSearches = 10;
constexpr std::size_t kMinToStart = 6;

}  // namespace

MarkerFilter::MarkerFilter(const MarkerModel& model, FrameRate rate)
    : model_(&model),
      process_(model.lengths, rate),
      solver_(model),
      cost_solver_(model),
      relocalizer_(model) {}

FrameLimits MarkerFilter::limits() const {
  FrameLimits limits;
  limits.prior_share = process_.prior_share();
  return limits;
}

void MarkerFilter::start(const Posture& posture) {
  filtered_ = process_.start(posture);
  started_ = true;
}

bool MarkerFilter::is_lost(std::span<const SeenMarker> seen, const Posture& posture) {
  if (seen.size() < kMinToStart) return false;
  const UnfoldedPosture& unfolded = solver_.unfold(posture);
  std::size_t off = 0;
  for (const SeenMarker& sample : seen) {
    const ModelMarker& marker = model_->markers[sample.marker];
    const double distance =
        (unfolded.point(marker.bone, marker.p_in_bone) - sample.p_in_world).norm();
    off += distance > kLostSigmas * std::hypot(marker.sigma_m, sample.sigma_m);
  }
  return static_cast<double>(off) > kLostShare * static_cast<double>(seen.size());
}

void MarkerFilter::relocalize(std::span<const SeenMarker> seen, Posture& posture) {
  if (until_next_search_ > 0) {
    --until_next_search_;
    return;
  }
  until_next_search_ = kFramesBetweenSearches;
  Posture as_it_is = posture;
  const double cost = cost_solver_.solve(seen, nullptr, as_it_is);
  const FoundPosture found = relocalizer_.find(seen);
  if (found.cost >= cost) return;
  posture = found.posture;
  // The prediction was wrong.
  predicted_ = process_.start(posture);
  PoseParameterProcess::to_prior(predicted_, prior_);
  (void)solver_.solve(seen, &prior_, posture, limits());
  until_next_search_ = 0;
  is_relocalized_ = true;
}

void MarkerFilter::step(std::span<const SeenMarker> seen) {
  is_relocalized_ = false;
  if (!started_) {
    if (seen.size() < kMinToStart) return;
    start(relocalizer_.find(seen).posture);
    predicted_ = filtered_;
  } else {
    process_.predict(filtered_, predicted_);
  }
  PoseParameterProcess::to_prior(predicted_, prior_);
  Posture posture = predicted_.posture;
  (void)solver_.solve(seen, &prior_, posture, limits());
  if (is_lost(seen, posture)) relocalize(seen, posture);
  solver_.factor().covariance(covariance_);
  process_.update(predicted_, posture, covariance_, filtered_);
}

}  // namespace marey::reconstruct
