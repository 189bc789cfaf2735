// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/find_moved_camera.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "calib/apparent_faults.h"
#include "calib/planar_pose.h"
#include "calib/refine_rig.h"
#include "calib/rig_model.h"
#include "core/assert.h"

namespace marey::calib {
namespace {

constexpr std::size_t kFewest = 30;  ///< Tags seen by two cameras at once.
constexpr std::size_t kMost = 1200;  ///< Likewise: more tell nothing new.
constexpr int kStretch = 6;          ///< Frames in a row: neighbours tell speeds.

/// A tag in one frame, by camera.
using Seen = std::map<std::size_t, const TagDetection*>;
using SeenTags = std::map<std::pair<TagId, int>, Seen>;

SeenTags look(std::span<const CameraDetections> detections,
              const std::map<TagId, double>& sizes_m) {
  SeenTags seen;
  for (std::size_t c = 0; c < detections.size(); ++c) {
    for (const FrameDetections& frame : detections[c].frames) {
      for (const TagDetection& tag : frame.tags) {
        if (sizes_m.contains(tag.id)) seen[{tag.id, frame.frame}][c] = &tag;
      }
    }
  }
  std::erase_if(seen, [](const auto& one) { return one.second.size() < 2; });
  // Whole stretches, evenly chosen.
  const auto every = static_cast<int>(1 + seen.size() / kMost);
  std::erase_if(
      seen, [&](const auto& one) { return one.first.second / kStretch % every != 0; });
  return seen;
}

double misfit_px(const Camera& camera,
                 const TagDetection& tag,
                 double size_m,
                 const RigidTransform& world_from_tag) {
  constexpr double kFar_px = 50.0;
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    const auto pixel = project(camera, world_from_tag * corner_in_tag(i, size_m));
    sum += pixel ? std::min(
                       kFar_px,
                       glm::distance(*pixel, tag.corners_px[static_cast<std::size_t>(i)]))
                 : kFar_px;
  }
  return sum;
}

/// Of the places that its views propose, the one that suits all of them best.
std::optional<RigidTransform> place(std::span<const Camera> cameras,
                                    const Seen& seen,
                                    double size_m) {
  std::array<glm::dvec3, 4> corners{};
  for (int i = 0; i < 4; ++i) {
    corners[static_cast<std::size_t>(i)] = corner_in_tag(i, size_m);
  }
  std::optional<RigidTransform> best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [c, tag] : seen) {
    for (const PlacedPlane& plane :
         place_plane(cameras[c].intrinsics, corners, tag->corners_px)) {
      const RigidTransform candidate =
          inverse(cameras[c].camera_from_world) * plane.camera_from_plane;
      double sum = 0.0;
      for (const auto& [other, view] : seen) {
        sum += misfit_px(cameras[other], *view, size_m, candidate);
      }
      if (sum >= least) continue;
      least = sum;
      best = candidate;
    }
  }
  return best;
}

}  // namespace

std::optional<ApparentMove> find_moved_camera(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    const std::map<TagId, double>& sizes_m) {
  MAREY_ASSERT(cameras.size() == detections.size());
  const SeenTags seen = look(detections, sizes_m);
  if (seen.size() < kFewest) return std::nullopt;
  RigModel model;
  double rate_hz = 0.0;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    RigCamera camera;
    camera.intrinsics = cameras[c].intrinsics;
    camera.world_from_camera = inverse(cameras[c].camera_from_world);
    model.cameras.push_back(camera);
    if (!detections[c].frames.empty()) rate_hz = detections[c].rate.hz;
  }
  std::map<TagId, std::size_t> target_of;
  for (const auto& [key, views] : seen) {
    const double size_m = sizes_m.at(key.first);
    const auto pose = place(cameras, views, size_m);
    if (!pose) continue;
    const auto [target, is_new] = target_of.try_emplace(key.first, model.targets.size());
    if (is_new) {
      model.targets.emplace_back();
      model.targets.back().pieces.push_back({key.first, {}, size_m, true, true});
    }
    model.targets[target->second].world_from_target[key.second] = *pose;
    for (const auto& [c, tag] : views) {
      Sighting sighting = sighting_of(*tag);
      sighting.camera = c;
      sighting.target = target->second;
      sighting.instant = key.second;
      sighting.frame = key.second;
      model.sightings.push_back(sighting);
    }
  }
  RefineOptions refine;
  refine.intrinsics = false;
  refine.camera_poses = false;
  refine.covariance = false;
  if (model.sightings.empty() || !refine_rig(model, refine)) return std::nullopt;
  // Clocks are in the base, so that no hypothesis is held for what they do.
  refine.offsets = true;
  return apparent_move(model, refine, rate_hz, MoveStart::kAnywhere);
}

}  // namespace marey::calib
