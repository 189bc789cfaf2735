// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/wand_model.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "calib/model/board_model.h"
#include "calib/model/static_tags.h"

namespace marey::calib {
namespace {

double min_hz(std::span<const CameraDetections> waved) {
  double hz = waved.front().rate.hz;
  for (const CameraDetections& camera : waved) hz = std::min(hz, camera.rate.hz);
  return hz;
}

/// Returns the instant of a frame; simultaneous frames share one.
int instant_of(std::span<const CameraDetections> waved,
               std::span<const double> offsets_s,
               std::size_t camera,
               int frame) {
  if (offsets_s.empty()) return frame;
  const double time_s = frame / waved[camera].rate.hz + offsets_s[camera];
  return static_cast<int>(std::lround(time_s * min_hz(waved)));
}

/// Returns at most about `max_count` of all, in evenly spaced sections of neighbours.
std::set<int> stretches(const std::vector<int>& all,
                        std::size_t max_count,
                        std::size_t length) {
  if (all.size() <= max_count) return {all.begin(), all.end()};
  std::set<int> chosen;
  const std::size_t count = std::max<std::size_t>(1, max_count / length);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = i * all.size() / count;
    const std::size_t last = std::min(first + length, all.size());
    chosen.insert(all.begin() + static_cast<std::ptrdiff_t>(first),
                  all.begin() + static_cast<std::ptrdiff_t>(last));
  }
  return chosen;
}

/// Returns the selected instants: those with the wand in the most cameras.
std::set<int> chosen_instants(const std::vector<Sighting>& sightings,
                              std::span<const CameraDetections> waved,
                              bool in_motion,
                              int max_instants) {
  std::map<int, std::set<std::size_t>> seen_by;
  for (const Sighting& s : sightings) seen_by[s.instant].insert(s.camera);
  // A motion has as many knots as frames; sightings of single cameras constrain their
  // lenses.
  const auto max_count = static_cast<std::size_t>(max_instants) * (in_motion ? 2 : 1);
  std::vector<int> instants;
  for (const std::size_t min_cameras : {2U, 1U}) {
    instants.clear();
    for (const auto& [instant, cameras] : seen_by) {
      if (cameras.size() >= min_cameras) instants.push_back(instant);
    }
    if (instants.size() >= max_count) break;
  }
  const double hz = min_hz(waved);
  // Clocks are observable through the motion of the wand between neighbouring instants.
  constexpr double kNear_s = 0.2;
  const double apart_s =
      static_cast<double>(instants.size()) / static_cast<double>(max_count) / hz;
  std::size_t length = apart_s > kNear_s ? 3 : 1;
  if (in_motion) length = static_cast<std::size_t>(std::max(10.0, std::round(hz)));
  return stretches(instants, max_count, length);
}

}  // namespace

RigModel static_wand_model(std::span<const CameraDetections> waved,
                           const Wand& wand,
                           const WandOptions& options,
                           std::span<const double> offsets_s) {
  RigModel model;
  model.targets.resize(1);
  std::map<TagId, std::vector<Sighting>> by_tag;
  for (const Wand::Tag& tag : wand.tags) by_tag[tag.id];
  std::vector<Sighting> all;
  for (std::size_t c = 0; c < waved.size(); ++c) {
    RigCamera camera;
    camera.intrinsics.lens = options.lens;
    camera.intrinsics.width_px = waved[c].width_px;
    camera.intrinsics.height_px = waved[c].height_px;
    if (!offsets_s.empty()) camera.offset_s = offsets_s[c];
    model.cameras.push_back(camera);
    for (const FrameDetections& frame : waved[c].frames) {
      for (const TagDetection& tag : frame.tags) {
        const auto same = [&](const Wand::Tag& w) { return w.id == tag.id; };
        const auto found = std::find_if(wand.tags.begin(), wand.tags.end(), same);
        if (found == wand.tags.end()) continue;
        Sighting sighting = sighting_of(tag);
        sighting.camera = c;
        sighting.target = kWand;
        sighting.frame = frame.frame;
        sighting.instant = instant_of(waved, offsets_s, c, frame.frame);
        sighting.time_s = frame.frame / waved[c].rate.hz;
        sighting.piece = static_cast<std::size_t>(found - wand.tags.begin());
        all.push_back(sighting);
      }
    }
  }
  const std::set<int> instants =
      chosen_instants(all, waved, !offsets_s.empty(), options.max_instants);
  std::erase_if(all, [&](const Sighting& s) { return !instants.contains(s.instant); });
  // A tag without sightings must not be the first one, whose frame is the wand's.
  std::map<std::size_t, std::size_t> piece_of;
  for (const Sighting& s : all) piece_of[s.piece];
  for (auto& [tag, piece] : piece_of) {
    piece = model.targets[kWand].pieces.size();
    model.targets[kWand].pieces.push_back(
        {wand.tags[tag].id, {}, wand.tags[tag].size_m, true, true});
  }
  for (Sighting& s : all) s.piece = piece_of.at(s.piece);
  model.sightings = std::move(all);
  if (options.use_scenery) add_static_tags(waved, wand, model);
  return model;
}

RigModel moving_wand_model(RigModel placed,
                           std::span<const CameraDetections> waved,
                           std::span<const double> offsets_s) {
  constexpr std::size_t kMinPoses = 4;
  const double hz = min_hz(waved);
  double spacing_s = 1.0;
  for (std::size_t c = 0; c < waved.size(); ++c) {
    spacing_s = std::min(spacing_s, 1.0 / waved[c].rate.hz);
    placed.cameras[c].offset_s = offsets_s[c];
  }
  spacing_s = std::max(spacing_s, 1.0 / 60.0);
  std::vector<TimedPose> poses;
  for (const auto& [instant, pose] : placed.targets[kWand].world_from_target) {
    poses.push_back({instant / hz, pose});
  }
  const std::vector<double> starts = parts_of_motion(poses, 1.0 / hz);
  RigidTarget still = std::move(placed.targets[kWand]);
  still.world_from_target.clear();
  still.knot_spacing_s = spacing_s;
  placed.targets[kWand] = still;
  std::vector<std::optional<std::size_t>> target_of(starts.size());
  bool is_first = true;
  auto next = poses.begin();
  for (std::size_t part = 0; part < starts.size(); ++part) {
    const auto end = std::find_if(next, poses.end(), [&](const TimedPose& p) {
      return part + 1 < starts.size() && p.time_s >= starts[part + 1];
    });
    if (static_cast<std::size_t>(end - next) >= kMinPoses) {
      RigidTarget target = still;
      target.world_from_target = knots_through({next, end}, spacing_s);
      target_of[part] = is_first ? kWand : placed.targets.size();
      if (is_first) {
        placed.targets[kWand] = std::move(target);
      } else {
        target.same_board_as = kWand;
        placed.targets.push_back(std::move(target));
      }
      is_first = false;
    }
    next = end;
  }
  std::vector<Sighting> kept;
  for (Sighting sighting : placed.sightings) {
    if (sighting.target == kWand) {
      const auto after =
          std::upper_bound(starts.begin(), starts.end(), sighting.instant / hz + 1e-9);
      if (after == starts.begin()) continue;
      const auto target = target_of[static_cast<std::size_t>(after - starts.begin()) - 1];
      if (!target) continue;
      sighting.target = *target;
      sighting.instant = 0;
    }
    kept.push_back(sighting);
  }
  placed.sightings = std::move(kept);
  return placed;
}

}  // namespace marey::calib
