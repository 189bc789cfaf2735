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
    : PostureFilter(model, rate),
      model_(&model),
      cost_solver_(model),
      relocalizer_(model) {}

void MarkerFilter::start(const Posture& posture) {
  filtered_ = process_.start(posture);
  started_ = true;
}

std::optional<Posture> MarkerFilter::find(Markers seen) {
  if (seen.size() < kMinToStart) return std::nullopt;
  return relocalizer_.find(seen).posture;
}

void MarkerFilter::solve(Markers seen, Posture& posture) {
  PoseParameterProcess::to_prior(predicted_, prior_);
  (void)solver_.solve(seen, &prior_, posture, limits());
}

bool MarkerFilter::is_lost(Markers seen, const Posture& posture) {
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

void MarkerFilter::repair(Markers seen, Posture& posture) {
  if (!is_lost(seen, posture)) return;
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
  restart(posture);
  solve(seen, posture);
  until_next_search_ = 0;
  is_relocalized_ = true;
}

void MarkerFilter::step(std::span<const SeenMarker> seen) {
  is_relocalized_ = false;
  Posture posture;
  (void)process_frame(seen, posture);
}

}  // namespace marey::reconstruct
