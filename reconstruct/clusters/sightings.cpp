// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/sightings.h"

#include <algorithm>
#include <limits>
#include <map>

#include "core/base/assert.h"

namespace marey::reconstruct {

Sightings group_sightings(std::span<const CameraDetections> detections,
                          std::span<const TagOnSegment> tags) {
  MAREY_ASSERT(!detections.empty());
  std::map<TagId, std::size_t> place;
  for (std::size_t i = 0; i < tags.size(); ++i) place[tags[i].id] = i;

  int first = std::numeric_limits<int>::max();
  int last = std::numeric_limits<int>::min();
  for (const CameraDetections& camera : detections) {
    if (camera.frames.empty()) continue;
    first = std::min(first, camera.frames.front().frame);
    last = std::max(last, camera.frames.back().frame);
  }
  Sightings sightings;
  sightings.rate = detections.front().rate;
  if (first > last) return sightings;
  sightings.first_frame = first;
  sightings.frames.resize(static_cast<std::size_t>(last - first + 1));
  for (const CameraDetections& camera : detections) {
    for (const FrameDetections& frame : camera.frames) {
      auto& out = sightings.frames[static_cast<std::size_t>(frame.frame - first)];
      for (const TagDetection& tag : frame.tags) {
        const auto found = place.find(tag.id);
        if (found != place.end()) out.push_back({camera.camera, found->second, &tag});
      }
    }
  }
  for (auto& frame : sightings.frames) {
    std::sort(frame.begin(), frame.end(), [](const TagSighting& a, const TagSighting& b) {
      return std::pair(a.tag, a.camera) < std::pair(b.tag, b.camera);
    });
  }
  return sightings;
}

HumanBone solved_segment(HumanBone segment) {
  if (segment == HumanBone::kLeftToes) return HumanBone::kLeftFoot;
  if (segment == HumanBone::kRightToes) return HumanBone::kRightFoot;
  return segment;
}

}  // namespace marey::reconstruct
