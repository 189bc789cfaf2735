// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/estimate_clocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <glm/geometric.hpp>

#include "calib/bundle/refine_rig.h"
#include "calib/model/board_model.h"
#include "calib/model/planar_pose.h"
#include "calib/model/rig_model.h"
#include "core/base/assert.h"
#include "core/base/quantile.h"

namespace marey::calib {
namespace {

constexpr std::size_t kMinShared = 6;

/// One tag in one frame of one camera, and its possible poses.
struct SeenTag {
  std::size_t camera = 0;
  int frame = 0;
  double time_s = 0.0;  ///< On the camera's own clock.
  const TagDetection* tag = nullptr;
  std::vector<RigidTransform> world_from_tag;  ///< One or two.
};

/// By tag, in the order of cameras and frames.
using SeenTags = std::map<TagId, std::vector<SeenTag>>;

SeenTags seen_tags(std::span<const Camera> cameras,
                   std::span<const CameraDetections> detections,
                   const std::map<TagId, double>& sizes_m) {
  SeenTags seen;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const RigidTransform world_from_camera = inverse(cameras[c].camera_from_world);
    for (const FrameDetections& frame : detections[c].frames) {
      for (const TagDetection& tag : frame.tags) {
        const auto size = sizes_m.find(tag.id);
        if (size == sizes_m.end()) continue;
        SeenTag found{c, frame.frame, frame.frame / detections[c].rate.hz, &tag, {}};
        std::array<glm::dvec3, 4> corners{};
        for (int i = 0; i < 4; ++i) {
          corners[static_cast<std::size_t>(i)] = corner_in_tag(i, size->second);
        }
        for (const PlacedPlane& plane :
             place_plane(cameras[c].intrinsics, corners, tag.corners_px)) {
          found.world_from_tag.push_back(world_from_camera * plane.camera_from_plane);
        }
        if (!found.world_from_tag.empty()) seen[tag.id].push_back(std::move(found));
      }
    }
  }
  return seen;
}

/// Returns the tags with the most frames shared by two cameras, in descending order.
std::vector<TagId> most_shared_tags(const SeenTags& seen, int max_tags) {
  std::vector<std::pair<std::size_t, TagId>> by_count;
  for (const auto& [id, views] : seen) {
    std::map<int, std::size_t> cameras;
    for (const SeenTag& view : views) ++cameras[view.frame];
    const auto shared = static_cast<std::size_t>(std::count_if(
        cameras.begin(), cameras.end(), [](const auto& f) { return f.second > 1; }));
    if (shared >= kMinShared) by_count.emplace_back(shared, id);
  }
  std::stable_sort(by_count.begin(), by_count.end(), [](const auto& a, const auto& b) {
    return a.first > b.first;
  });
  std::vector<TagId> ids;
  for (const auto& [count, id] : by_count) {
    if (static_cast<int>(ids.size()) < max_tags) ids.push_back(id);
  }
  return ids;
}

/// Position of a tag's centre by camera, tag and time step.
using Paths = std::vector<std::map<std::pair<TagId, int>, glm::dvec3>>;

/// Returns the lag, in steps, at which b's tags are nearest to a's, and the number that
/// agree. Tags at rest are near at any lag: for equal scores the smallest lag is used.
std::pair<int, int> best_lag(const Paths& paths,
                             std::size_t a,
                             std::size_t b,
                             int max_lag) {
  constexpr double kFar_m = 0.2;
  double best = 0.0;
  std::pair<int, int> found{0, 0};
  for (int i = 0; i <= 2 * max_lag; ++i) {
    const int lag = (i % 2 == 0 ? 1 : -1) * ((i + 1) / 2);  // 0, -1, 1, -2, 2...
    double score = 0.0;
    int count = 0;
    for (const auto& [place, p] : paths[a]) {
      const auto other = paths[b].find({place.first, place.second - lag});
      if (other == paths[b].end()) continue;
      const double off_m = glm::distance(p, other->second);
      if (off_m >= kFar_m) continue;
      score += kFar_m - off_m;
      ++count;
    }
    if (score <= 1.001 * best) continue;
    best = score;
    found = {lag, count};
  }
  return found;
}

/// Estimates offsets to about a frame, along the pairs of cameras with the most shared
/// tags.
std::vector<double> first_offsets(const SeenTags& seen,
                                  std::span<const CameraDetections> detections,
                                  double max_s) {
  const std::size_t count = detections.size();
  double step_s = 0.0;
  for (const CameraDetections& d : detections) step_s = std::max(step_s, 1.0 / d.rate.hz);
  std::vector<double> given_s;
  for (const CameraDetections& d : detections) {
    given_s.push_back(d.offset ? seconds(*d.offset) : 0.0);
  }
  Paths paths(count);
  for (const auto& [id, views] : seen) {
    for (const SeenTag& view : views) {
      const double time_s = view.time_s + given_s[view.camera];
      paths[view.camera][{id, static_cast<int>(std::lround(time_s / step_s))}] =
          view.world_from_tag[0].translation;
    }
  }
  const int max_lag = static_cast<int>(std::lround(max_s / step_s));
  std::vector<std::optional<double>> offset_s(count);
  offset_s[0] = given_s[0];
  while (true) {
    std::pair<int, int> best{0, 0};
    std::size_t from = 0;
    std::size_t to = 0;
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = 0; b < count; ++b) {
        if (!offset_s[a] || offset_s[b]) continue;
        const auto lag = best_lag(paths, a, b, max_lag);
        if (lag.second <= best.second) continue;
        best = lag;
        from = a;
        to = b;
      }
    }
    if (best.second == 0) break;
    offset_s[to] = *offset_s[from] - given_s[from] + given_s[to] + best.first * step_s;
  }
  std::vector<double> out;
  for (std::size_t c = 0; c < count; ++c) out.push_back(offset_s[c].value_or(given_s[c]));
  return out;
}

/// Resolves planar ambiguities: selects the pose of a view that is nearer to other
/// cameras' sightings at about that time. Views without others nearby are omitted.
std::vector<TimedPose> resolve_ambiguities(std::span<const SeenTag> views,
                                           std::span<const double> offsets_s,
                                           double near_s) {
  std::vector<TimedPose> poses;
  for (const SeenTag& view : views) {
    const double time_s = view.time_s + offsets_s[view.camera];
    double minimum = std::numeric_limits<double>::infinity();
    TimedPose best{time_s, {}};
    for (const SeenTag& other : views) {
      const double other_s = other.time_s + offsets_s[other.camera];
      if (other.camera == view.camera || std::abs(other_s - time_s) > near_s) continue;
      for (const RigidTransform& mine : view.world_from_tag) {
        for (const RigidTransform& theirs : other.world_from_tag) {
          const double apart = glm::length(
              rotation_vector(glm::conjugate(mine.rotation) * theirs.rotation));
          if (apart >= minimum) continue;
          minimum = apart;
          best.world_from_target = mine;
        }
      }
    }
    if (minimum < 0.5) poses.push_back(best);
  }
  std::stable_sort(poses.begin(), poses.end(), [](const auto& a, const auto& b) {
    return a.time_s < b.time_s;
  });
  return poses;
}

void add_tag(TagId id,
             double size_m,
             std::span<const SeenTag> views,
             double spacing_s,
             RigModel& model) {
  std::vector<double> offsets_s;
  for (const RigCamera& camera : model.cameras) offsets_s.push_back(camera.offset_s);
  const std::vector<TimedPose> poses =
      resolve_ambiguities(views, offsets_s, 1.5 * spacing_s);
  const std::vector<double> starts = parts_of_motion(poses, spacing_s);
  auto next = poses.begin();
  for (std::size_t part = 0; part < starts.size(); ++part) {
    const double until_s = part + 1 < starts.size() ? starts[part + 1] : 1e300;
    const auto end = std::find_if(
        next, poses.end(), [&](const TimedPose& p) { return p.time_s >= until_s; });
    if (end - next >= 4) {
      RigidTarget target;
      target.pieces.push_back({id, {}, size_m, true, true});
      target.knot_spacing_s = spacing_s;
      target.world_from_target = knots_through({next, end}, spacing_s);
      for (const SeenTag& view : views) {
        const double seen_s = view.time_s + offsets_s[view.camera];
        if (seen_s < next->time_s || seen_s > (end - 1)->time_s) continue;
        Sighting sighting = sighting_of(*view.tag);
        sighting.camera = view.camera;
        sighting.target = model.targets.size();
        sighting.frame = view.frame;
        sighting.time_s = view.time_s;
        model.sightings.push_back(sighting);
      }
      model.targets.push_back(std::move(target));
    }
    next = end;
  }
}

}  // namespace

std::optional<std::vector<SolvedClock>> estimate_clocks(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> detections,
    const std::map<TagId, double>& sizes_m,
    const ClockOptions& options) {
  MAREY_ASSERT(cameras.size() == detections.size());
  if (cameras.empty()) return std::nullopt;
  const SeenTags seen = seen_tags(cameras, detections, sizes_m);
  const std::vector<double> offsets_s =
      first_offsets(seen, detections, options.max_offset_s);
  RigModel model;
  double spacing_s = 1.0;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    RigCamera camera;
    camera.intrinsics = cameras[c].intrinsics;
    camera.world_from_camera = inverse(cameras[c].camera_from_world);
    camera.offset_s = offsets_s[c];
    model.cameras.push_back(camera);
    spacing_s = std::min(spacing_s, 1.0 / detections[c].rate.hz);
  }
  spacing_s = std::max(spacing_s, 1.0 / 60.0);
  for (const TagId id : most_shared_tags(seen, options.max_tags)) {
    add_tag(id, sizes_m.at(id), seen.at(id), spacing_s, model);
  }
  if (model.sightings.empty()) return std::nullopt;
  RefineOptions refine;
  refine.intrinsics = false;
  refine.camera_poses = false;
  refine.offsets = true;
  refine.drifts = options.solve_drifts;
  refine.line_delays = options.solve_line_delays;
  const auto uncertainty = refine_rig(model, refine);
  if (!uncertainty) return std::nullopt;
  std::vector<SolvedClock> clocks;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const RigCamera& camera = model.cameras[c];
    const ClockSigma& sigma = uncertainty->clocks[c];
    clocks.push_back({camera.offset_s,
                      sigma.offset_s,
                      camera.drift,
                      sigma.drift,
                      camera.line_delay_s,
                      sigma.line_delay_s});
  }
  return clocks;
}

}  // namespace marey::calib
