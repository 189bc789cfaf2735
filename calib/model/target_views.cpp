// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/target_views.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace marey::calib {
namespace {

/// Times at which a camera saw a moving target.
struct Meeting {
  std::set<std::pair<std::size_t, int>> instants;  ///< For targets with instants.
  std::vector<double> times_s;                     ///< For targets that move smoothly.
};

int together(const Meeting& a, const Meeting& b, double within_s) {
  int count = 0;
  for (const auto& instant : a.instants) count += b.instants.contains(instant) ? 1 : 0;
  for (const double time_s : a.times_s) {
    const auto next =
        std::lower_bound(b.times_s.begin(), b.times_s.end(), time_s - within_s);
    count += next != b.times_s.end() && *next < time_s + within_s ? 1 : 0;
  }
  return count;
}

}  // namespace

std::vector<TargetView> target_views(const RigModel& model) {
  // In the documented order of the result.
  std::map<std::tuple<std::size_t, int, std::size_t>, TargetView> views;
  std::vector<Camera> cameras;
  for (const RigCamera& camera : model.cameras) cameras.push_back(camera_of(camera));
  for (const Sighting& sighting : model.sightings) {
    const RigidTarget& target = model.targets[sighting.target];
    const auto pose = world_from_target(model, sighting);
    if (!pose || (!target.pieces.empty() && !target.pieces[sighting.piece].is_placed)) {
      continue;
    }
    const Camera& camera = cameras[sighting.camera];
    std::array<glm::dvec2, 4> seen{};
    for (std::size_t i = 0; i < 4; ++i) seen[i] = sighting.corners[i].pixel_px;
    if (sighting.count == 4) seen = unshrunk(seen, camera.tag_shrinkage);
    TargetView& view = views[{sighting.camera, sighting.frame, sighting.target}];
    view.camera = CameraId{static_cast<int>(sighting.camera)};
    view.frame = sighting.frame;
    view.target = static_cast<int>(sighting.target);
    view.stays = target.stays || sighting.frame == kFloorInstant;
    view.world_from_target = *pose;
    for (int i = 0; i < sighting.count; ++i) {
      const auto expected =
          project(camera, *pose * corner_in_target(target, sighting, i));
      const glm::dvec2 at = seen[static_cast<std::size_t>(i)];
      SeenCorner corner;
      corner.seen_px = at;
      // Behind the camera, as in errors_px().
      corner.error_px =
          expected ? at - *expected : glm::dvec2(camera.intrinsics.width_px, 0.0);
      corner.is_outlier = sighting.is_outlier;
      view.corners.push_back(corner);
    }
  }
  std::vector<TargetView> out;
  out.reserve(views.size());
  for (auto& [key, view] : views) out.push_back(std::move(view));
  return out;
}

std::vector<int> shared_views(const RigModel& model) {
  const std::size_t count = model.cameras.size();
  std::vector<Meeting> meetings(count);
  std::vector<std::set<double>> times_s(count);
  double within_s = 0.0;
  for (const Sighting& sighting : model.sightings) {
    const RigidTarget& target = model.targets[sighting.target];
    if (target.stays || sighting.frame == kFloorInstant) continue;
    if (target.knot_spacing_s > 0.0) {
      const RigCamera& camera = model.cameras[sighting.camera];
      within_s = std::max(within_s, target.knot_spacing_s);
      times_s[sighting.camera].insert(sighting.time_s * (1.0 + camera.drift) +
                                      camera.offset_s);
    } else {
      meetings[sighting.camera].instants.insert({sighting.target, sighting.instant});
    }
  }
  for (std::size_t c = 0; c < count; ++c) {
    meetings[c].times_s.assign(times_s[c].begin(), times_s[c].end());
  }
  std::vector<int> shared(count * count, 0);
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a; b < count; ++b) {
      shared[a * count + b] = shared[b * count + a] =
          together(meetings[a], meetings[b], within_s);
    }
  }
  return shared;
}

}  // namespace marey::calib
