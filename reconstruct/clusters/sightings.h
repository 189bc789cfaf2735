// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/body.h"
#include "core/camera.h"
#include "core/detection.h"

namespace marey::reconstruct {

/// One body tag in one image.
struct TagSighting {
  CameraId camera{};
  std::size_t tag = 0;                      ///< Position in the subject's list of tags.
  const TagDetection* detection = nullptr;  ///< Borrowed from the CameraDetections.
};

/// All sightings of body tags, frame by frame, over the frames that any camera has.
/// Within a frame ordered by tag, then camera.
struct Sightings {
  FrameRate rate;
  int first_frame = 0;
  std::vector<std::vector<TagSighting>> frames;

  [[nodiscard]] int last_frame() const {
    return first_frame + static_cast<int>(frames.size()) - 1;
  }
};

/// Groups the detections of all cameras by frame index and keeps only the tags of `tags`.
/// Borrows from `detections`. Precondition: at least one camera.
[[nodiscard]] Sightings group_sightings(std::span<const CameraDetections> detections,
                                        std::span<const TagOnSegment> tags);

/// Returns the segment whose motion a tag on `segment` follows in marey's model: the foot
/// for toes, which are rigid with it, and otherwise the segment itself.
[[nodiscard]] HumanBone solved_segment(HumanBone segment);

}  // namespace marey::reconstruct
