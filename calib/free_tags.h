// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: the tags of a trial as if each moved by itself. What two cameras see
// of one at once tells of the cameras, whatever wears it.

#include <map>
#include <span>
#include <vector>

#include "calib/rig_model.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/ids.h"

namespace marey::calib {

struct FreeTags {
  std::span<const Camera> cameras;
  std::span<const CameraDetections> detections;      ///< One per camera, in their order.
  const std::map<TagId, double>* sizes_m = nullptr;  ///< Of the tags that are used.
  double rate_hz = 0.0;
};

/// Returns the arguments as they are, with their rate. Precondition: all cameras that
/// have frames run at one rate.
[[nodiscard]] FreeTags free_tags(std::span<const Camera> cameras,
                                 std::span<const CameraDetections> detections,
                                 const std::map<TagId, double>& sizes_m);

/// Builds the rig of the cameras at their places and of each tag's place in each frame of
/// `detections`, which are those of `tags` at other times; without sightings if fewer
/// than 30 tags are seen by two cameras at once.
[[nodiscard]] RigModel free_tag_model(const FreeTags& tags,
                                      std::span<const CameraDetections> detections);

/// Cameras that are brought in step by what they see.
struct InStep {
  std::vector<CameraDetections> detections;  ///< As of the first camera's instants.
  /// Per camera, after the first: as found, though it may be beyond what can be applied.
  std::vector<double> late_s;
  std::vector<double>
      sigma_s;  ///< About 1 if no moving tag tells; 0 of the first camera.
};

/// Finds by how much each camera sees later than the first, up to one and a half frames
/// more or less than `start_s` says (one entry per camera).
[[nodiscard]] InStep in_step(const FreeTags& tags, std::span<const double> start_s);

}  // namespace marey::calib
