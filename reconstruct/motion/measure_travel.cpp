// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/motion/measure_travel.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/quantile.h"

namespace marey::reconstruct {
namespace {

constexpr std::size_t kMinFrames = 5;
constexpr std::size_t kMinTags = 6;

/// One tag in the pictures of one camera.
struct Track {
  std::vector<glm::dvec2> middles_px;
  std::vector<double> sides_px;  ///< The longest of each picture: the least oblique.
};

std::map<TagId, Track> tracks_in(const CameraDetections& camera,
                                 const std::map<TagId, double>& sizes_m) {
  std::map<TagId, Track> tracks;
  for (const FrameDetections& frame : camera.frames) {
    for (const TagDetection& tag : frame.tags) {
      if (!sizes_m.contains(tag.id)) continue;
      glm::dvec2 middle(0.0);
      double side_px = 0.0;
      for (std::size_t c = 0; c < 4; ++c) {
        middle += 0.25 * tag.corners_px[c];
        side_px = std::max(side_px,
                           glm::distance(tag.corners_px[c], tag.corners_px[(c + 1) % 4]));
      }
      tracks[tag.id].middles_px.push_back(middle);
      tracks[tag.id].sides_px.push_back(side_px);
    }
  }
  return tracks;
}

double travel_px(const std::vector<glm::dvec2>& places) {
  glm::dvec2 middle(0.0);
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<double> along;
    for (const glm::dvec2& place : places) along.push_back(place[axis]);
    middle[axis] = median(std::move(along));
  }
  std::vector<double> away;
  for (const glm::dvec2& place : places) away.push_back(glm::distance(place, middle));
  return quantile(std::move(away), 0.8);
}

}  // namespace

std::optional<double> measure_travel(std::span<const CameraDetections> detections,
                                     std::span<const TagOnSegment> tags) {
  std::map<TagId, double> sizes_m;
  for (const TagOnSegment& tag : tags) sizes_m[tag.id] = tag.size_m;
  std::map<TagId, double> travels_m;
  for (const CameraDetections& camera : detections) {
    for (const auto& [id, track] : tracks_in(camera, sizes_m)) {
      if (track.middles_px.size() < kMinFrames) continue;
      const double m_per_px = sizes_m.at(id) / median(track.sides_px);
      double& travel_m = travels_m[id];
      travel_m = std::max(travel_m, m_per_px * travel_px(track.middles_px));
    }
  }
  if (travels_m.size() < kMinTags) return std::nullopt;
  std::vector<double> travels;
  for (const auto& [id, travel_m] : travels_m) travels.push_back(travel_m);
  return quantile(std::move(travels), 0.75);
}

}  // namespace marey::reconstruct
