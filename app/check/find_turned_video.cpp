// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/check/find_turned_video.h"

#include <cstddef>
#include <vector>

#include "reconstruct/clusters/check_views.h"

namespace marey::app {
namespace {

/// Returns the detections with all pictures turned by 180 degrees.
CameraDetections turned(CameraDetections camera) {
  const glm::dvec2 far_corner_px(camera.width_px - 1, camera.height_px - 1);
  for (FrameDetections& frame : camera.frames) {
    for (TagDetection& tag : frame.tags) {
      for (glm::dvec2& corner_px : tag.corners_px) corner_px = far_corner_px - corner_px;
    }
  }
  return camera;
}

}  // namespace

std::optional<Error> find_turned_video(std::span<const Camera> cameras,
                                       std::span<const CameraDetections> detections,
                                       std::span<const TagOnSegment> tags) {
  for (std::size_t c = 0; c < detections.size(); ++c) {
    if (detections[c].frames.empty()) continue;
    std::vector<CameraDetections> candidate(detections.begin(), detections.end());
    candidate[c] = turned(std::move(candidate[c]));
    if (!reconstruct::check_views(cameras, candidate, tags)) continue;
    return bad_input(detections[c].source,
                     "its pictures are upside down, compared to the calibration videos "
                     "of camera " +
                         cameras[c].name,
                     "turn this video by 180 degrees, or calibrate with videos of the "
                     "same orientation");
  }
  return std::nullopt;
}

}  // namespace marey::app
