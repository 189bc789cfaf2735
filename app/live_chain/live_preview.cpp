// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_preview.h"

#include <algorithm>
#include <cmath>

#include "app/live_chain/live_zmp.h"
#include "core/base/assert.h"
#include "core/base/smooth_step.h"

namespace marey::app {
namespace {

using reconstruct::TrackReport;
using reconstruct::TrackState;

constexpr double kFootFade_s = 0.2;
// After this time without poses the displacement has ended.
constexpr double kMaxPlannedGap_s = 5.0;

std::int64_t frames_of(double time_s, FrameRate rate) {
  return std::llround(time_s * rate.hz);
}

}  // namespace

Result<LivePreview> LivePreview::make(std::span<const Skeleton* const> bodies,
                                      FrameRate rate) {
  if (!(rate.hz >= kMinRate_hz && rate.hz <= kMaxRate_hz)) {
    return bad_input("--balance preview",
                     "it needs cameras of 10 to 500 Hz",
                     "leave the option out, or change the rate of the cameras");
  }
  PreviewTimes times;
  times.rate = rate;
  times.delay = frames_of(kDelay_s, rate);
  // As wide as the window of the estimate without a delay. A derivative needs 5 frames.
  times.half_window =
      std::max<std::int64_t>(2, frames_of(0.5 * LiveZmp::kWindow_s, rate));
  times.fade = std::max<std::int64_t>(1, frames_of(kFootFade_s, rate));
  return LivePreview(bodies, times);
}

LivePreview::LivePreview(std::span<const Skeleton* const> bodies,
                         const PreviewTimes& times)
    : times_(times), kept_(static_cast<std::size_t>(times.kept())) {
  MAREY_ASSERT(!bodies.empty());
  for (const Skeleton* body : bodies) {
    bodies_.push_back(std::make_unique<PreviewBody>(*body, times));
  }
  skeleton_ = *bodies.front();
  if (auto map = retarget::map_body(skeleton_)) map_ = *std::move(map);
  world_from_joint_.resize(skeleton_.joints.size());
  for (Kept& one : kept_) one.uncertainty.reserve(skeleton_.joints.size());
  frame_.performer = rest_pose(skeleton_);
  frame_.balanced_performer = frame_.performer;
  for (const Skeleton* avatar : bodies.subspan(1)) {
    frame_.avatars.push_back(rest_pose(*avatar));
  }
  frame_.uncertainty.reserve(skeleton_.joints.size());
}

void LivePreview::step(std::int64_t number,
                       const TrackReport& track,
                       std::span<const JointUncertainty> uncertainty,
                       const Pose& performer,
                       std::span<const Pose> avatars) {
  MAREY_ASSERT(avatars.size() + 1 == bodies_.size());
  MAREY_ASSERT(newest_ < 0 || number > last_number_);
  const std::int64_t steps = newest_ < 0 ? 1 : number - last_number_;
  last_number_ = number;
  detect_standing(performer, track, static_cast<double>(steps) / times_.rate.hz);
  if (steps > 1) fill_gap(steps - 1, track, uncertainty, performer, avatars);

  const bool has_pose = track.state != TrackState::kWaiting;
  push(performer, avatars, has_pose ? 1.0 : 0.0);
  Kept& now = kept(newest_);
  now.track = track;
  now.uncertainty.assign(uncertainty.begin(), uncertainty.end());
  now.standing = standing_;
  plan(track.state == TrackState::kTracked);
  show();
}

/// Detects the standing feet of the newest pose. A body that is not seen does not stand,
/// and its next pose may be elsewhere.
void LivePreview::detect_standing(const Pose& performer,
                                  const TrackReport& track,
                                  double since_last_s) {
  standing_ = {};
  if (track.state != TrackState::kTracked || !map_) return stance_.reset();
  world_from_joints(skeleton_, performer, world_from_joint_);
  stance_.step(*map_, world_from_joint_, since_last_s);
  standing_ = stance_.standing();
}

void LivePreview::push(const Pose& performer,
                       std::span<const Pose> avatars,
                       double share) {
  ++newest_;
  bodies_[0]->push(performer, share);
  for (std::size_t a = 0; a < avatars.size(); ++a)
    bodies_[a + 1]->push(avatars[a], share);
}

/// Adds frames between the newest one and these poses. If the body was not seen before or
/// is not seen now, the newest frame is repeated.
void LivePreview::fill_gap(std::int64_t missing,
                           const TrackReport& track,
                           std::span<const JointUncertainty> uncertainty,
                           const Pose& performer,
                           std::span<const Pose> avatars) {
  const TrackReport before = kept(newest_).track;
  const bool is_tracked =
      before.state == TrackState::kTracked && track.state == TrackState::kTracked;
  const bool is_short = missing <= times_.half_window;
  // Only the last of these frames are kept.
  const std::int64_t skipped = std::max<std::int64_t>(0, missing - times_.kept());
  const std::int64_t planned =
      std::min(skipped, frames_of(kMaxPlannedGap_s, times_.rate));
  for (std::int64_t i = 0; i < planned; ++i) plan(false);
  double share = static_cast<double>(skipped + 1) / static_cast<double>(missing + 1);
  for (std::int64_t i = skipped; i < missing; ++i) {
    const std::int64_t last = newest_;
    push(performer, avatars, is_tracked ? share : 0.0);
    share = 1.0 / static_cast<double>(missing - i);
    Kept& now = kept(newest_);
    now.track = is_tracked ? track : before;
    now.standing = is_tracked && is_short ? standing_ : decltype(standing_){};
    if (is_tracked) {
      now.uncertainty.assign(uncertainty.begin(), uncertainty.end());
    } else if (&now != &kept(last)) {
      now.uncertainty = kept(last).uncertainty;
    }
    for (JointUncertainty& joint : now.uncertainty) {
      if (joint.source == Source::kMeasured) joint.source = Source::kRepaired;
    }
    plan(is_tracked && is_short);
  }
}

void LivePreview::plan(bool is_steady) {
  steady_ = is_steady ? steady_ + 1 : 0;
  const bool is_known = steady_ > 2 * times_.half_window;
  std::array<retarget::StandingFoot, 2> standing{};
  if (is_known) standing = kept(newest_ - times_.half_window).standing;
  for (const auto& body : bodies_) body->plan(is_known, standing);
}

/// Share by which a foot keeps its place: 1 while it stands, less within a fade of that.
double LivePreview::hold(std::int64_t frame, std::size_t side) const {
  for (std::int64_t off = 0; off < times_.fade; ++off) {
    for (const std::int64_t at : {frame - off, frame + off}) {
      if (at < 0 || at > newest_) continue;
      const retarget::StandingFoot& foot = kept_[times_.slot(at)].standing[side];
      if (!foot.heel && !foot.ball) continue;
      return smooth_step(1.0 -
                         static_cast<double>(off) / static_cast<double>(times_.fade));
    }
  }
  return 0.0;
}

void LivePreview::show() {
  const std::int64_t frame = newest_ - times_.delay;
  if (frame < 0) return;
  const Kept& shown = kept(frame);
  frame_.track = shown.track;
  frame_.uncertainty.assign(shown.uncertainty.begin(), shown.uncertainty.end());
  frame_.standing = shown.standing;
  if (shown.track.state == TrackState::kWaiting) return;
  const std::array<double, 2> holds{hold(frame, 0), hold(frame, 1)};
  bodies_[0]->copy(frame, frame_.performer);
  bodies_[0]->show(holds, frame_.balanced_performer);
  for (std::size_t a = 0; a < frame_.avatars.size(); ++a) {
    bodies_[a + 1]->show(holds, frame_.avatars[a]);
  }
}

}  // namespace marey::app
