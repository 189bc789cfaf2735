// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/static_tags.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <glm/geometric.hpp>

#include "core/base/quantile.h"

namespace marey::calib {
namespace {

constexpr std::size_t kMinFrames = 8;
constexpr double kStillPx = 1.0;

/// Returns a tag at rest, averaged over the frames of one camera; nullopt if it moves.
std::optional<TagDetection> at_rest(const std::vector<const TagDetection*>& tags) {
  if (tags.size() < kMinFrames) return std::nullopt;
  TagDetection out = *tags.front();
  double strays_px = 0.0;
  for (std::size_t c = 0; c < 4; ++c) {
    std::vector<double> xs;
    std::vector<double> ys;
    for (const TagDetection* tag : tags) {
      xs.push_back(tag->corners_px[c].x);
      ys.push_back(tag->corners_px[c].y);
    }
    const glm::dvec2 middle(median(std::move(xs)), median(std::move(ys)));
    std::vector<double> off_px;
    for (const TagDetection* tag : tags) {
      off_px.push_back(glm::distance(tag->corners_px[c], middle));
    }
    strays_px = std::max(strays_px, quantile(std::move(off_px), 0.9));
    out.corners_px[c] = middle;
  }
  if (strays_px > kStillPx) return std::nullopt;
  const double shrink = 1.0 / std::sqrt(static_cast<double>(tags.size()));
  out.sigma_px *= std::max(0.75, shrink);
  return out;
}

}  // namespace

void add_static_tags(std::span<const CameraDetections> waved,
                     const Wand& wand,
                     RigModel& model) {
  std::map<TagId, std::vector<Sighting>> found;
  for (std::size_t c = 0; c < waved.size(); ++c) {
    std::map<TagId, std::vector<const TagDetection*>> tags;
    for (const FrameDetections& frame : waved[c].frames) {
      for (const TagDetection& tag : frame.tags) tags[tag.id].push_back(&tag);
    }
    for (const Wand::Tag& tag : wand.tags) tags.erase(tag.id);
    for (const auto& [id, views] : tags) {
      const auto tag = at_rest(views);
      if (!tag) continue;
      Sighting sighting = sighting_of(*tag);
      sighting.camera = c;
      sighting.frame = kFloorInstant;
      found[id].push_back(sighting);
    }
  }
  RigidTarget background;
  background.stays = true;
  for (auto& [id, views] : found) {
    if (views.size() < 2) continue;
    for (Sighting& sighting : views) {
      sighting.target = model.targets.size();
      sighting.piece = background.pieces.size();
      model.sightings.push_back(sighting);
    }
    background.pieces.push_back({id, {}, 1.0, false, false});
  }
  if (!background.pieces.empty()) model.targets.push_back(std::move(background));
}

}  // namespace marey::calib
