// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_health.h"

#include <algorithm>

namespace marey::app {

live::PageCameraStatus camera_status(const LiveCameraFigures& now,
                                     const LiveCameraFigures* before,
                                     int tags) {
  using State = live::PageCameraState;
  const bool has_come = !before || now.pictures > before->pictures;
  live::PageCameraStatus out;
  out.name = now.name;
  out.frames = static_cast<std::uint64_t>(now.pictures);
  out.dropped =
      static_cast<std::uint64_t>(now.dropped + now.stale + now.broken + now.unused);
  if (now.health.state == capture::CameraState::kLost) {
    out.state = State::kLost;
  } else {
    out.state = has_come ? State::kStreaming : State::kSilent;
  }
  if (out.state != State::kStreaming) out.detail = now.health.trouble;
  if (out.state == State::kStreaming) out.tags = tags;
  return out;
}

live::PageOutput output_status(const OutputCounts& now, const OutputCounts* before) {
  const live::UdpCounts then = before ? before->counts : live::UdpCounts{};
  live::PageOutput out;
  out.name = now.name;
  out.sent = static_cast<std::uint64_t>(now.counts.sent);
  out.failed = static_cast<std::uint64_t>(now.counts.failed + now.counts.refused);
  if (now.counts.refused > then.refused) {
    out.detail = "nobody listens there";
  } else if (now.counts.failed > then.failed) {
    out.detail = "packets cannot be sent there";
  }
  return out;
}

SeenInVain::SeenInVain(const Body& body) {
  for (const PlacedTag& tag : body.tags) worn_.push_back(tag.tag.id);
  std::ranges::sort(worn_);
}

void SeenInVain::add(const LiveInstant& instant,
                     const reconstruct::TrackReport& found) {
  const auto sees_some = [this](const CameraTags& view) {
    return std::ranges::count_if(view.tags, [this](const TagDetection& tag) {
             return std::ranges::binary_search(worn_, tag.id);
           }) >= kFewest;
  };
  const bool fits = found.state == reconstruct::TrackState::kTracked &&
                    found.rms_px <= kMost_px;
  if (fits || std::ranges::count_if(instant.views, sees_some) < 2) {
    since_.reset();
    is_so_ = false;
    return;
  }
  if (!since_) since_ = instant.time;
  is_so_ = seconds(instant.time - *since_) >= kAfter_s;
}

}  // namespace marey::app
