// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/find_moved_camera.h"

#include <vector>

#include "calib/apparent_faults.h"
#include "calib/free_tags.h"
#include "calib/refine_rig.h"

namespace marey::calib {

std::optional<ApparentMove> find_moved_camera(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    const std::map<TagId, double>& sizes_m) {
  const FreeTags tags = free_tags(cameras, detections, sizes_m);
  const std::vector<double> start_s(cameras.size(), 0.0);
  RigModel model = free_tag_model(tags, in_step(tags, start_s).detections);
  RefineOptions refine;
  refine.intrinsics = false;
  refine.camera_poses = false;
  refine.covariance = false;
  if (model.sightings.empty() || !refine_rig(model, refine)) return std::nullopt;
  // Clocks are in the base, so that no hypothesis is held for what they do.
  refine.offsets = true;
  return apparent_move(model, refine, tags.rate_hz, MoveStart::kAnywhere);
}

}  // namespace marey::calib
