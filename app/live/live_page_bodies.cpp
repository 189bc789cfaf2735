// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Data of every body in a frame of the live page.
#include "app/live/live_page.h"

namespace marey::app {

using reconstruct::TrackState;

/// Creates the balance, which covers the skeletons of the scene.
void LivePage::make_balance() {
  std::vector<const Skeleton*> bodies;
  for (const live::PageSkeleton& one : scene_.skeletons) bodies.push_back(&one.skeleton);
  balance_.emplace(bodies);
  last_tracked_.reset();
}

/// Updates the supporting feet of the performer. After a loss of the body they are reset,
/// because the performer may have moved.
void LivePage::update_balance(const LiveInstant& instant, const LiveResult& result) {
  if (result.track.state != TrackState::kTracked) {
    last_tracked_.reset();
    return;
  }
  if (!last_tracked_) balance_->reset();
  const double steps =
      last_tracked_ ? static_cast<double>(instant.number - *last_tracked_) : 1.0;
  last_tracked_ = instant.number;
  balance_->step(*result.pose, steps / scene_.rate_hz);
}

/// Sets the current poses of all bodies. The balance of a lost body is unknown.
void LivePage::pose_bodies(const LiveResult& result) {
  const bool is_there = result.track.state != TrackState::kWaiting;
  const bool is_seen = result.track.state == TrackState::kTracked;
  const auto pose = [&](std::size_t figure, const Pose* posture) {
    live::PageFigure& one = figures_[figure];
    one.pose = is_there ? posture : nullptr;
    one.balance.reset();
    if (!is_seen) return;
    // Handles belong to the first avatar.
    const auto handles = figure == 1 ? result.handles : std::span<const HandleState>();
    const auto* balance = balance_->measure(figure, *posture, handles);
    if (balance == nullptr) return;
    one.balance = {
        balance->centre_of_mass_in_world, balance->support_xz_m, balance->zmp_xz_m};
  };
  pose(0, result.pose);
  for (std::size_t a = 0; a < result.avatars.size(); ++a) pose(a + 1, &result.avatars[a]);
  figures_[0].uncertainty =
      is_there ? result.uncertainty : std::span<const JointUncertainty>();
  figures_[0].tracking.reset();
  if (!is_there) return;
  live::PageTracking& tracking = figures_[0].tracking.emplace();
  if (result.track.tags_used > 0) tracking.residual_px = result.track.rms_px;
  if (!is_seen) return;
  const auto& [left, right] = balance_->standing();
  tracking.bears = {left.heel, left.ball, right.heel, right.ball};
}

}  // namespace marey::app
