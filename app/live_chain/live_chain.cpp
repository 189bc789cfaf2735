// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_chain.h"

#include <utility>

#include "app/live_chain/live_avatar.h"
#include "app/motion/error_of_file.h"
#include "core/base/assert.h"
#include "core/base/stopwatch.h"
#include "retarget/body/body_map.h"

namespace marey::app {
namespace {

using reconstruct::BodyTracker;
using reconstruct::TrackState;

}  // namespace

LiveChain::LiveChain(BodyTracker tracker,
                     std::span<const Camera> cameras,
                     const LiveSettings& settings)
    : cameras_(cameras.begin(), cameras.end()),
      rate_(settings.rate),
      tracker_(std::move(tracker)),
      unshrunk_(cameras.size()),
      views_(cameras.size()),
      pose_(rest_pose(tracker_.skeleton())) {}

Result<LiveChain> LiveChain::make(const Body& body,
                                  std::span<const Camera> cameras,
                                  std::span<const OpenedAvatar> avatars,
                                  const LiveSettings& settings) {
  MAREY_ASSERT(avatars.size() == settings.avatars.size());
  reconstruct::TrackBodyOptions options;
  options.camera_sigma_m = settings.camera_sigma_m;
  options.lag_known = settings.lag_known;
  auto tracker = BodyTracker::create(body, cameras, settings.rate, options);
  if (!tracker) return tracker.error();
  LiveChain chain(*std::move(tracker), cameras, settings);
  for (const OpenedAvatar& avatar : avatars) {
    auto retarget = make_live_retarget(chain.performer(), avatar);
    if (!retarget) return retarget.error();
    chain.retargets_.push_back(*std::move(retarget));
    chain.avatar_poses_.push_back(rest_pose(avatar.skeleton));
  }
  if (!avatars.empty()) {
    const OpenedAvatar& first = avatars.front();
    auto handles = LiveHandles::make(first.file.stem().string(), first.skeleton);
    if (!handles) return of_file(first.file, handles.error());
    chain.handles_ = *std::move(handles);
  }
  for (const VmcStream& stream : settings.streams) {
    const OpenedAvatar* avatar = stream.avatar ? &avatars[*stream.avatar] : nullptr;
    auto vmc_body =
        make_vmc_body(avatar ? avatar->skeleton : chain.performer(), avatar, stream.rest);
    if (!vmc_body) return vmc_body.error();
    live::VmcEncoderOptions encoding;
    encoding.mtu_bytes = stream.mtu_bytes;
    encoding.begin = settings.vmc_begin;
    encoding.info.listen_port = stream.listen_port;
    if (avatar) {
      // The name in the settings, because the file in a take has another name.
      const std::filesystem::path name = settings.avatars[*stream.avatar];
      encoding.info.vrm_path = name.string();
      encoding.info.vrm_title = name.stem().string();
    }
    auto encoder = live::VmcEncoder::make(encoding);
    if (!encoder) return encoder.error();
    chain.streams_.push_back({stream, *std::move(vmc_body), *std::move(encoder), {}});
  }
  chain.packets_.resize(chain.streams_.size());
  if (settings.balance_preview) {
    std::vector<const Skeleton*> bodies{&chain.performer()};
    for (const OpenedAvatar& avatar : avatars) bodies.push_back(&avatar.skeleton);
    auto preview = LivePreview::make(bodies, settings.rate);
    if (!preview) return preview.error();
    chain.preview_ = *std::move(preview);
    chain.newest_avatars_ = chain.avatar_poses_;
    if (!avatars.empty()) chain.dragged_ = avatars.front().skeleton;
    chain.world_from_dragged_.resize(chain.dragged_.joints.size());
  }
  if (settings.vrchat) {
    // The performer's rest pose is a T-pose.
    chain.trackers_.emplace(chain.performer());
    chain.world_from_joint_.resize(chain.performer().joints.size());
    chain.packets_.emplace_back();
  }
  return chain;
}

const LiveResult& LiveChain::step(const LiveInstant& instant,
                                  const LiveRequests& requests) {
  MAREY_ASSERT(!last_number_ || instant.number > *last_number_);
  const double steps =
      last_number_ ? static_cast<double>(instant.number - *last_number_) : 1.0;
  const double since_last_s = steps / rate_.hz;
  last_number_ = instant.number;
  result_.number = instant.number;
  result_.time = instant.time;
  const Stopwatch solving;
  take_in(instant);
  (void)tracker_.step(views_, since_last_s, pose_, uncertainty_);
  result_.track = tracker_.last();
  result_.solve_s = solving.seconds();
  const Stopwatch retargeting;
  if (result_.track.state != TrackState::kWaiting) {
    retarget_avatars(since_last_s);
  }
  if (preview_) preview();
  if (result_.track.state != TrackState::kWaiting) drag(requests, since_last_s);
  result_.retarget_s = retargeting.seconds();
  const Stopwatch encoding;
  encode(instant.time, requests);
  result_.encode_s = encoding.seconds();
  result_.pose = preview_ ? &preview_->frame().performer : &pose_;
  result_.uncertainty = preview_ ? preview_->frame().uncertainty : uncertainty_;
  result_.avatars = avatar_poses_;
  if (handles_) result_.handles = handles_->handles();
  result_.packets = packets_;
  return result_;
}

/// Converts the detections to the tracker's input, without tag shrinkage.
void LiveChain::take_in(const LiveInstant& instant) {
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    unshrunk_[c].clear();
    views_[c] = {};
  }
  for (const CameraTags& seen : instant.views) {
    const std::size_t c = index(seen.camera);
    MAREY_ASSERT(c < cameras_.size());
    for (const TagDetection& tag : seen.tags) {
      unshrunk_[c].push_back(tag);
      unshrunk_[c].back().corners_px =
          unshrunk(tag.corners_px, cameras_[c].tag_shrinkage);
    }
    views_[c] = {unshrunk_[c], seconds(seen.time - instant.time)};
  }
}

void LiveChain::retarget_avatars(double since_last_s) {
  const bool is_lost = result_.track.state == TrackState::kLost;
  for (std::size_t a = 0; a < retargets_.size(); ++a) {
    // After a relocalization the feet must not be dragged to the new position.
    if (was_lost_ && !is_lost) retargets_[a].reset();
    Pose& newest = preview_ ? newest_avatars_[a] : avatar_poses_[a];
    retargets_[a].step(pose_, since_last_s, newest);
  }
  was_lost_ = is_lost;
}

/// Replaces the track and the poses of the avatars by those of the delayed frame.
void LiveChain::preview() {
  preview_->step(result_.number, result_.track, uncertainty_, pose_, newest_avatars_);
  result_.track = preview_->frame().track;
  avatar_poses_ = preview_->frame().avatars;
}

/// Adapts the first avatar to its handles. Not called before the body is found.
void LiveChain::drag(const LiveRequests& requests, double since_last_s) {
  if (!handles_) return;
  for (const HandleRequest& request : requests.handles) handles_->ask(request);
  Pose& avatar = avatar_poses_.front();
  if (preview_) {
    world_from_joints(dragged_, avatar, world_from_dragged_);
    handles_->step(world_from_dragged_, preview_->frame().standing, since_last_s, avatar);
    return;
  }
  handles_->step(retargets_.front().world_from_joint(),
                 retargets_.front().standing(),
                 since_last_s,
                 avatar);
}

void LiveChain::encode(Timestamp time, const LiveRequests& requests) {
  const Pose& performer = preview_ ? preview_->frame().balanced_performer : pose_;
  live::VmcStatus status;
  status.tracking = result_.track.state == TrackState::kTracked && !requests.behind;
  for (std::size_t s = 0; s < streams_.size(); ++s) {
    Stream& stream = streams_[s];
    if (s < requests.streams.size()) {
      const LiveRequests::OfStream& asked = requests.streams[s];
      if (asked.periods) stream.encoder.set_periods(*asked.periods);
      if (asked.info) stream.encoder.request_info();
    }
    const Pose& pose =
        stream.what.avatar ? avatar_poses_[*stream.what.avatar] : performer;
    stream.body.to_vmc(pose, stream.vmc_pose);
    const auto packets = stream.encoder.encode(time, stream.vmc_pose, status);
    packets_[s].resize(packets.size());
    for (std::size_t p = 0; p < packets.size(); ++p) {
      packets_[s][p].assign(packets[p].begin(), packets[p].end());
    }
  }
  if (!trackers_) return;
  // A body that was not found has no position.
  packets_.back().clear();
  if (result_.track.state == TrackState::kWaiting) return;
  world_from_joints(tracker_.skeleton(), performer, world_from_joint_);
  const auto packet = trackers_->encode(world_from_joint_);
  packets_.back().emplace_back(packet.begin(), packet.end());
}

}  // namespace marey::app
