// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_health.h"

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
    out.detail = "no program receives the packets there";
  } else if (now.counts.failed > then.failed) {
    out.detail = "packets cannot be sent there";
  }
  return out;
}

WornSegments::WornSegments(const Body& body) {
  for (const PlacedTag& placed : body.tags) {
    HumanBone bone = placed.tag.segment;
    // The toes are solved together with the foot.
    if (bone == HumanBone::kLeftToes) bone = HumanBone::kLeftFoot;
    if (bone == HumanBone::kRightToes) bone = HumanBone::kRightFoot;
    bones_.push_back(bone);
  }
  std::ranges::sort(bones_);
  const auto same = std::ranges::unique(bones_);
  bones_.erase(same.begin(), same.end());
}

std::vector<std::string> WornSegments::unseen(
    std::span<const JointUncertainty> uncertainty) const {
  std::vector<std::string> names;
  for (const HumanBone bone : bones_) {
    if (index(bone) >= uncertainty.size()) continue;
    if (uncertainty[index(bone)].segment_source != Source::kInferred) continue;
    names.emplace_back(name(bone));
  }
  return names;
}

void add_subject_status(reconstruct::TrackState state,
                        const LiveStatistics& figures,
                        const std::vector<std::string>& unseen,
                        live::PageStatus& status) {
  using State = reconstruct::TrackState;
  for (const live::PageCameraStatus& camera : status.cameras) {
    if (camera.state == live::PageCameraState::kStreaming) continue;
    const bool is_lost = camera.state == live::PageCameraState::kLost;
    status.warnings.push_back("camera " + camera.name +
                              (is_lost ? " is lost" : " sends no pictures"));
  }
  for (const std::string& segment : unseen) {
    status.warnings.push_back(segment + " has not been seen for more than a second");
  }
  if (figures.has_unmatched_tags) {
    status.warnings.emplace_back("tags are visible but no body pose fits them");
  }
  if (figures.flow != Flow::kSteady) status.warnings.push_back(figures.flow_text);
  if (state == State::kTracked) {
    status.subject = status.warnings.empty() ? live::PageSubject::kTracked
                                             : live::PageSubject::kPartly;
  } else {
    status.subject =
        state == State::kLost ? live::PageSubject::kLost : live::PageSubject::kWaiting;
  }
  if (figures.flow == Flow::kBehind) status.subject = live::PageSubject::kBehind;
  if (figures.flow == Flow::kStopped) status.subject = live::PageSubject::kStopped;
}

UnmatchedTagsDetector::UnmatchedTagsDetector(const Body& body) {
  for (const PlacedTag& tag : body.tags) worn_.push_back(tag.tag.id);
  std::ranges::sort(worn_);
}

void UnmatchedTagsDetector::add(const LiveInstant& instant,
                                const reconstruct::TrackReport& found) {
  const auto sees_some = [this](const CameraTags& view) {
    return std::ranges::count_if(view.tags, [this](const TagDetection& tag) {
             return std::ranges::binary_search(worn_, tag.id);
           }) >= kMinTags;
  };
  const bool fits =
      found.state == reconstruct::TrackState::kTracked && found.rms_px <= kMax_px;
  if (fits || std::ranges::count_if(instant.views, sees_some) < 2) {
    since_.reset();
    has_unmatched_ = false;
    return;
  }
  if (!since_) since_ = instant.time;
  has_unmatched_ = seconds(instant.time - *since_) >= kAfter_s;
}

}  // namespace marey::app
