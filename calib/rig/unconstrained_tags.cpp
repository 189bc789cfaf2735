// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/unconstrained_tags.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "calib/bundle/refine_rig.h"
#include "calib/model/planar_pose.h"
#include "calib/rig/apparent_clocks.h"
#include "core/base/assert.h"

namespace marey::calib {
namespace {

constexpr std::size_t kMin = 30;    ///< Tags seen by two cameras at once.
constexpr std::size_t kMax = 1200;  ///< The same; more add little information.
constexpr int kStretch = 6;         ///< Consecutive frames, to compute velocities.

/// A tag in one frame, by camera.
using Seen = std::map<std::size_t, const TagDetection*>;
using SeenTags = std::map<std::pair<TagId, int>, Seen>;

SeenTags seen_tags(std::span<const CameraDetections> detections,
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
  // Whole sections of consecutive frames, evenly selected.
  const auto every = static_cast<int>(1 + seen.size() / kMax);
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

/// Returns the pose with the lowest total error, among those estimated from single views.
std::optional<RigidTransform> place(std::span<const Camera> cameras,
                                    const Seen& seen,
                                    double size_m) {
  std::array<glm::dvec3, 4> corners{};
  for (int i = 0; i < 4; ++i) {
    corners[static_cast<std::size_t>(i)] = corner_in_tag(i, size_m);
  }
  std::optional<RigidTransform> best;
  double minimum = std::numeric_limits<double>::infinity();
  for (const auto& [c, tag] : seen) {
    for (const PlacedPlane& plane :
         place_plane(cameras[c].intrinsics, corners, tag->corners_px)) {
      const RigidTransform candidate =
          inverse(cameras[c].camera_from_world) * plane.camera_from_plane;
      double sum = 0.0;
      for (const auto& [other, view] : seen) {
        sum += misfit_px(cameras[other], *view, size_m, candidate);
      }
      if (sum >= minimum) continue;
      minimum = sum;
      best = candidate;
    }
  }
  return best;
}

/// Returns a tag's corners `by` frames later, interpolated between the frames before and
/// after; nullopt if neither shows the tag.
std::optional<std::array<glm::dvec2, 4>> corners_at(const TagDetection* before,
                                                    const TagDetection& now,
                                                    const TagDetection* after,
                                                    double by) {
  if (before == nullptr && after == nullptr) return std::nullopt;
  std::array<glm::dvec2, 4> out = now.corners_px;
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec2& at = now.corners_px[i];
    if (before != nullptr && after != nullptr) {
      const glm::dvec2& a = before->corners_px[i];
      const glm::dvec2& b = after->corners_px[i];
      out[i] += 0.5 * by * (b - a) + 0.5 * by * by * (b - 2.0 * at + a);
    } else {
      out[i] += by * (before != nullptr ? at - before->corners_px[i]
                                        : after->corners_px[i] - at);
    }
  }
  return out;
}

const TagDetection* tag_in(const CameraDetections& camera,
                           const std::map<int, std::size_t>& places,
                           int frame,
                           TagId id) {
  const auto found = places.find(frame);
  if (found == places.end()) return nullptr;
  for (const TagDetection& tag : camera.frames[found->second].tags) {
    if (tag.id == id) return &tag;
  }
  return nullptr;
}

/// Returns the detections at the first camera's instants.
CameraDetections at_one_time(const CameraDetections& camera, double frames_late) {
  std::map<int, std::size_t> places;
  for (std::size_t i = 0; i < camera.frames.size(); ++i) {
    places[camera.frames[i].frame] = i;
  }
  CameraDetections out = camera;
  for (FrameDetections& frame : out.frames) {
    std::vector<TagDetection> kept;
    for (TagDetection& tag : frame.tags) {
      const auto corners = corners_at(tag_in(camera, places, frame.frame - 1, tag.id),
                                      tag,
                                      tag_in(camera, places, frame.frame + 1, tag.id),
                                      -frames_late);
      if (!corners) continue;
      tag.corners_px = *corners;
      kept.push_back(tag);
    }
    frame.tags = std::move(kept);
  }
  return out;
}

}  // namespace

UnconstrainedTags unconstrained_tags(std::span<const Camera> cameras,
                                     std::span<const CameraDetections> detections,
                                     const std::map<TagId, double>& sizes_m) {
  MAREY_ASSERT(cameras.size() == detections.size() && !cameras.empty());
  UnconstrainedTags tags{cameras, detections, &sizes_m, 0.0};
  for (const CameraDetections& camera : detections) {
    if (!camera.frames.empty()) tags.rate_hz = camera.rate.hz;
  }
  return tags;
}

RigModel unconstrained_tag_model(const UnconstrainedTags& tags,
                                 std::span<const CameraDetections> detections) {
  RigModel model;
  for (const Camera& camera : tags.cameras) {
    RigCamera one;
    one.intrinsics = camera.intrinsics;
    one.world_from_camera = inverse(camera.camera_from_world);
    model.cameras.push_back(one);
  }
  const SeenTags seen = seen_tags(detections, *tags.sizes_m);
  if (seen.size() < kMin) return model;
  std::map<TagId, std::size_t> target_of;
  for (const auto& [key, views] : seen) {
    const double size_m = tags.sizes_m->at(key.first);
    const auto pose = place(tags.cameras, views, size_m);
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
  return model;
}

SynchronizedDetections synchronize_detections(const UnconstrainedTags& tags,
                                              std::span<const double> start_s) {
  MAREY_ASSERT(start_s.size() == tags.cameras.size());
  // Frames. A larger delay means that the cameras were not synchronous.
  constexpr double kMaxDelay_frames = 1.5;
  constexpr double kConverged_frames = 0.01;  // Frames.
  constexpr int kRounds = 5;  // Each reduces the remaining delay to a quarter or less.
  SynchronizedDetections out;
  out.detections.assign(tags.detections.begin(), tags.detections.end());
  std::vector<double> applied_s(start_s.begin(), start_s.end());
  for (std::size_t c = 0; c < applied_s.size(); ++c) {
    if (applied_s[c] == 0.0) continue;
    out.detections[c] = at_one_time(tags.detections[c], tags.rate_hz * applied_s[c]);
  }
  out.late_s = applied_s;
  out.sigma_s.assign(applied_s.size(), 1.0);
  RefineOptions refine;
  refine.intrinsics = false;
  refine.camera_poses = false;
  refine.covariance = false;
  refine.quick = true;
  for (int round = 0; round < kRounds; ++round) {
    RigModel model = unconstrained_tag_model(tags, out.detections);
    if (model.sightings.empty() || !refine_rig(model, refine)) return out;
    const auto clocks = apparent_clocks(model, tags.rate_hz);
    bool is_in_step = true;
    for (std::size_t c = 0; c < applied_s.size(); ++c) {
      const double by_s = clocks[c].offset_s;
      out.late_s[c] = applied_s[c] + by_s;
      out.sigma_s[c] = clocks[c].sigma_s;
      if (std::abs(by_s) <
              std::max(kConverged_frames / tags.rate_hz, 3.0 * clocks[c].sigma_s) ||
          std::abs(out.late_s[c] - start_s[c]) * tags.rate_hz > kMaxDelay_frames) {
        continue;
      }
      applied_s[c] = out.late_s[c];
      out.detections[c] = at_one_time(tags.detections[c], tags.rate_hz * applied_s[c]);
      is_in_step = false;
    }
    if (is_in_step) break;
  }
  return out;
}

}  // namespace marey::calib
