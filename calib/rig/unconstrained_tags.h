// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: the tags of a trial, each with a free pose in each frame. A tag that
// two cameras see at once constrains the cameras, whatever it is attached to.

#include <map>
#include <span>
#include <vector>

#include "calib/model/rig_model.h"
#include "core/base/ids.h"
#include "core/camera.h"
#include "core/detection.h"

namespace marey::calib {

struct UnconstrainedTags {
  std::span<const Camera> cameras;
  std::span<const CameraDetections> detections;      ///< One per camera, in their order.
  const std::map<TagId, double>* sizes_m = nullptr;  ///< Edges of the tags to use.
  double rate_hz = 0.0;
};

/// Returns the arguments unchanged, with their rate. Precondition: all cameras that have
/// frames run at one rate.
[[nodiscard]] UnconstrainedTags unconstrained_tags(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    const std::map<TagId, double>& sizes_m);

/// Builds the rig of the cameras at their poses and of each tag's pose in each frame of
/// `detections`. These are the detections of `tags`, resampled in time. The rig has no
/// sightings if two cameras see fewer than 30 tags at once.
[[nodiscard]] RigModel unconstrained_tag_model(
    const UnconstrainedTags& tags, std::span<const CameraDetections> detections);

/// Detections that are resampled to common instants.
struct SynchronizedDetections {
  std::vector<CameraDetections> detections;  ///< At the first camera's instants.
  /// Estimated delay of each camera after the first; may exceed the applicable range.
  std::vector<double> late_s;
  std::vector<double> sigma_s;  ///< About 1 without a moving tag; 0 for the first camera.
};

/// Estimates the delay of each camera relative to the first, up to one and a half frames
/// before or after `start_s` (one entry per camera).
[[nodiscard]] SynchronizedDetections synchronize_detections(
    const UnconstrainedTags& tags, std::span<const double> start_s);

}  // namespace marey::calib
