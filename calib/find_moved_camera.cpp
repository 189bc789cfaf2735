// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/find_moved_camera.h"

#include <vector>

#include "calib/apparent_faults.h"
#include "calib/free_tags.h"
#include "calib/refine_rig.h"

namespace marey::calib {

namespace {

/// Smaller moves are not solved again with the camera's clock left free.
constexpr double kMinMove_px = 0.5;

std::optional<ApparentMove> move_at(const FreeTags& tags,
                                    std::span<const CameraDetections> in_step) {
  RigModel model = free_tag_model(tags, in_step);
  RefineOptions refine;
  refine.intrinsics = false;
  refine.camera_poses = false;
  refine.covariance = false;
  if (model.sightings.empty() || !refine_rig(model, refine)) return std::nullopt;
  // Clocks are in the base, so that no hypothesis is held for what they do.
  refine.offsets = true;
  return apparent_move(model, refine, tags.rate_hz, MoveStart::kAnywhere);
}

}  // namespace

std::optional<ApparentMove> find_moved_camera(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    const std::map<TagId, double>& sizes_m) {
  const std::vector<double> start_s(cameras.size(), 0.0);
  const FreeTags tags = free_tags(cameras, detections, sizes_m);
  auto first = move_at(tags, in_step(tags, start_s).detections);
  if (!first || first->moved_px < kMinMove_px) return first;
  // A camera that was moved looks late where most that it sees goes one way: its clock is
  // left alone, and solved for together with its move.
  std::vector<CameraDetections> others(detections.begin(), detections.end());
  others[index(first->camera)].frames.clear();
  std::vector<CameraDetections> again =
      in_step(free_tags(cameras, others, sizes_m), start_s).detections;
  again[index(first->camera)] = detections[index(first->camera)];
  auto second = move_at(tags, again);
  return second && second->camera == first->camera ? second : first;
}

}  // namespace marey::calib
