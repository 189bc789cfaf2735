// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/marker_filter.h"

#include <cmath>

namespace marey::reconstruct {
namespace {

// The body is lost when so large a share of the markers is so many sigmas off.
constexpr double kLostSigmas = 6.0;
constexpr double kLostShare = 0.25;
// Who is lost and not found is looked for again so many frames later.
constexpr int kFramesBetweenLooks = 10;
constexpr std::size_t kFewestToStart = 6;

}  // namespace

MarkerFilter::MarkerFilter(const MarkerModel& model, FrameRate rate)
    : model_(&model),
      process_(model.lengths, rate),
      solver_(model),
      judge_(model),
      finder_(model) {}

FrameLimits MarkerFilter::limits() const {
  FrameLimits limits;
  limits.habit_share = process_.habit_share();
  return limits;
}

void MarkerFilter::start(const Posture& posture) {
  filtered_ = process_.start(posture);
  started_ = true;
}

bool MarkerFilter::is_lost(std::span<const SeenMarker> seen, const Posture& posture) {
  if (seen.size() < kFewestToStart) return false;
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

void MarkerFilter::look_anew(std::span<const SeenMarker> seen, Posture& posture) {
  if (until_next_look_ > 0) {
    --until_next_look_;
    return;
  }
  until_next_look_ = kFramesBetweenLooks;
  Posture as_it_is = posture;
  const double cost = judge_.solve(seen, nullptr, as_it_is);
  const FoundPosture found = finder_.find(seen);
  if (found.cost >= cost) return;
  posture = found.posture;
  // What was expected was wrong.
  predicted_ = process_.start(posture);
  SlotProcess::to_prior(predicted_, prior_);
  (void)solver_.solve(seen, &prior_, posture, limits());
  until_next_look_ = 0;
  found_anew_ = true;
}

void MarkerFilter::step(std::span<const SeenMarker> seen) {
  found_anew_ = false;
  if (!started_) {
    if (seen.size() < kFewestToStart) return;
    start(finder_.find(seen).posture);
    predicted_ = filtered_;
  } else {
    process_.predict(filtered_, predicted_);
  }
  SlotProcess::to_prior(predicted_, prior_);
  Posture posture = predicted_.posture;
  (void)solver_.solve(seen, &prior_, posture, limits());
  if (is_lost(seen, posture)) look_anew(seen, posture);
  solver_.factor().covariance(covariance_);
  process_.update(predicted_, posture, covariance_, filtered_);
}

}  // namespace marey::reconstruct
