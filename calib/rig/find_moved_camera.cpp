// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/find_moved_camera.h"

#include <vector>

#include "calib/bundle/refine_rig.h"
#include "calib/rig/apparent_faults.h"
#include "calib/rig/unconstrained_tags.h"

namespace marey::calib {

namespace {

/// Smaller moves are not tested again with a free clock of the camera.
constexpr double kMinMove_px = 0.5;

std::optional<ApparentMove> move_at(const UnconstrainedTags& tags,
                                    std::span<const CameraDetections> in_step) {
  RigModel model = unconstrained_tag_model(tags, in_step);
  RefineOptions refine;
  refine.intrinsics = false;
  refine.camera_poses = false;
  refine.covariance = false;
  if (model.sightings.empty() || !refine_rig(model, refine)) return std::nullopt;
  // Clocks are in the base, so that their effects are not attributed to a hypothesis.
  refine.offsets = true;
  return apparent_move(model, refine, tags.rate_hz, MoveStart::kAnywhere);
}

}  // namespace

std::optional<ApparentMove> find_moved_camera(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    const std::map<TagId, double>& sizes_m) {
  const std::vector<double> start_s(cameras.size(), 0.0);
  const UnconstrainedTags tags = unconstrained_tags(cameras, detections, sizes_m);
  auto first = move_at(tags, synchronize_detections(tags, start_s).detections);
  if (!first || first->moved_px < kMinMove_px) return first;
  // A moved camera looks late if most targets move in one direction: its clock is left
  // unchanged here and solved for together with its move.
  std::vector<CameraDetections> others(detections.begin(), detections.end());
  others[index(first->camera)].frames.clear();
  std::vector<CameraDetections> again =
      synchronize_detections(unconstrained_tags(cameras, others, sizes_m), start_s)
          .detections;
  again[index(first->camera)] = detections[index(first->camera)];
  auto second = move_at(tags, again);
  return second && second->camera == first->camera ? second : first;
}

}  // namespace marey::calib
