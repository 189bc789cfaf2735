// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/calibrate_wand.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "calib/judge_rig.h"
#include "calib/place_cameras.h"
#include "calib/place_tags.h"
#include "calib/refine_rig.h"
#include "calib/rig_model.h"
#include "calib/scenery.h"
#include "core/assert.h"
#include "core/quantile.h"

namespace marey::calib {
namespace {

constexpr double kHopelessMedianPx = 2.5;
constexpr std::size_t kWand = 0;
constexpr std::size_t kScenery = 1;

/// The frames that are taken: those that show the wand to most cameras, evenly thinned.
std::set<int> chosen_frames(std::span<const CameraDetections> waved,
                            const Wand& wand,
                            int most) {
  std::map<int, int> views;
  for (const CameraDetections& camera : waved) {
    for (const FrameDetections& frame : camera.frames) {
      const bool shows = std::any_of(frame.tags.begin(), frame.tags.end(), [&](auto& t) {
        return std::any_of(
            wand.tags.begin(), wand.tags.end(), [&](auto& w) { return w.id == t.id; });
      });
      if (shows) ++views[frame.frame];
    }
  }
  std::vector<int> frames;
  for (const int fewest : {2, 1}) {
    frames.clear();
    for (const auto& [frame, count] : views) {
      if (count >= fewest) frames.push_back(frame);
    }
    if (static_cast<int>(frames.size()) >= most) break;
  }
  std::set<int> chosen;
  const auto count = std::min(frames.size(), static_cast<std::size_t>(most));
  for (std::size_t i = 0; i < count; ++i)
    chosen.insert(frames[i * frames.size() / count]);
  return chosen;
}

RigModel model_of(std::span<const CameraDetections> waved,
                  const Wand& wand,
                  const WandOptions& options) {
  RigModel model;
  model.targets.resize(1);
  std::map<TagId, std::size_t> piece_of;
  for (const Wand::Tag& tag : wand.tags) {
    piece_of[tag.id] = model.targets[kWand].pieces.size();
    model.targets[kWand].pieces.push_back({tag.id, {}, tag.size_m, true, true});
  }
  const std::set<int> frames = chosen_frames(waved, wand, options.most_instants);
  for (std::size_t c = 0; c < waved.size(); ++c) {
    RigCamera camera;
    camera.intrinsics.lens = options.lens;
    camera.intrinsics.width_px = waved[c].width_px;
    camera.intrinsics.height_px = waved[c].height_px;
    model.cameras.push_back(camera);
    for (const FrameDetections& frame : waved[c].frames) {
      if (!frames.contains(frame.frame)) continue;
      for (const TagDetection& tag : frame.tags) {
        const auto piece = piece_of.find(tag.id);
        if (piece == piece_of.end()) continue;
        Sighting sighting = sighting_of(tag);
        sighting.camera = c;
        sighting.target = kWand;
        sighting.instant = sighting.frame = frame.frame;
        sighting.piece = piece->second;
        model.sightings.push_back(sighting);
      }
    }
  }
  if (options.use_scenery) add_scenery(waved, wand, model);
  return model;
}

bool has_lens(const WandOptions& options, std::size_t camera) {
  return camera < options.lenses.size() && options.lenses[camera].has_value();
}

/// Fills in first intrinsics. A camera that cannot tell starts as the others of its
/// picture size do, or as any.
bool start_lenses(RigModel& model, const WandOptions& options) {
  const LensModel lens = options.lens;
  std::vector<std::optional<Intrinsics>> found;
  std::vector<double> ratios;
  for (std::size_t c = 0; c < model.cameras.size(); ++c) {
    std::vector<const Sighting*> own;
    std::vector<const Sighting*> of_wand;
    for (const Sighting& s : model.sightings) {
      if (s.camera != c) continue;
      own.push_back(&s);
      if (s.target == kWand) of_wand.push_back(&s);
    }
    const Intrinsics& k = model.cameras[c].intrinsics;
    const bool is_given = has_lens(options, c);
    found.push_back(
        is_given
            ? options.lenses[c]
            : estimate_intrinsics_from_tags(
                  of_wand.size() >= 20 ? of_wand : own, lens, k.width_px, k.height_px));
    if (found.back() && (is_given || of_wand.size() >= 20)) {
      ratios.push_back(found.back()->focal_px.x / k.width_px);
    }
  }
  if (ratios.empty()) return false;
  const double usual = median(std::move(ratios));
  for (std::size_t c = 0; c < model.cameras.size(); ++c) {
    Intrinsics& k = model.cameras[c].intrinsics;
    if (has_lens(options, c)) {
      k = *options.lenses[c];
      continue;
    }
    k.centre_px = {0.5 * (k.width_px - 1), 0.5 * (k.height_px - 1)};
    k.focal_px = glm::dvec2(usual * k.width_px);
    if (!found[c]) continue;
    // Few single tags tell a focal length to a tenth or so: alike cameras are likely.
    const double own = found[c]->focal_px.x / k.width_px;
    if (std::abs(own / usual - 1.0) > 0.25) k.focal_px = found[c]->focal_px;
  }
  return true;
}

Error not_connected(std::span<const std::string> names, const std::vector<bool>& placed) {
  std::string reached;
  std::string missed;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string& list = placed[i] ? reached : missed;
    list += (list.empty() ? "" : ", ") + names[i];
  }
  return bad_input("",
                   "nothing joins the cameras {" + reached + "} and {" + missed +
                       "}: too few instants show the wand to both at once",
                   "record the calibration again and carry the wand through where both "
                   "groups see it");
}

WandCalibration to_calibration(std::span<const std::string> names,
                               const RigModel& model,
                               const RigDoubt& doubt) {
  WandCalibration out;
  out.rig = judge_rig(names, model, doubt);
  for (const Piece& piece : model.targets[kWand].pieces) {
    if (piece.is_placed) out.wand_from_tag[piece.id] = piece.target_from_piece;
  }
  out.world_from_wand = model.targets[kWand].world_from_target;
  if (model.targets.size() > kScenery) {
    for (const Piece& piece : model.targets[kScenery].pieces) {
      if (piece.is_placed) out.scenery_sizes_m[piece.id] = piece.size_m;
    }
  }
  return out;
}

}  // namespace

Result<WandCalibration> calibrate_wand(std::span<const std::string> names,
                                       std::span<const CameraDetections> waved,
                                       const Wand& wand,
                                       const WandOptions& options) {
  MAREY_ASSERT(names.size() == waved.size() && !wand.tags.empty());
  RigModel model = model_of(waved, wand, options);
  if (std::none_of(model.sightings.begin(), model.sightings.end(), [](const Sighting& s) {
        return s.target == kWand;
      })) {
    return bad_input("",
                     "no tag of the wand is seen by any camera",
                     "check the ids of the wand's tags and the tag family in "
                     "session.toml against the print");
  }
  if (!start_lenses(model, options)) {
    return bad_input("",
                     "the wand is seen too little to tell any camera's lens",
                     "record the calibration again: carry the wand through the whole "
                     "volume, near and far, and turn it");
  }
  const std::vector<bool> placed = place_by_tags(model);
  if (std::find(placed.begin(), placed.end(), false) != placed.end()) {
    return not_connected(names, placed);
  }
  RefineOptions refine;
  refine.fixed_camera = 0;
  for (std::size_t c = 0; c < waved.size(); ++c) {
    refine.held_lenses.push_back(has_lens(options, c));
  }
  auto doubt = refine_rig(model, refine);
  if (!doubt) {
    return bad_input("",
                     "the bundle adjustment of the cameras does not converge",
                     "record the calibration again: carry the wand through the whole "
                     "volume and turn it");
  }
  move_world(world_from_upright_camera() * inverse(model.cameras[0].world_from_camera),
             model,
             *doubt);
  WandCalibration out = to_calibration(names, model, *doubt);
  if (out.rig.median_px > kHopelessMedianPx) {
    std::array<char, 120> text{};
    std::snprintf(text.data(),
                  text.size(),
                  "calibration ends %.1f px away from what the cameras saw (good: under "
                  "0.5)",
                  out.rig.median_px);
    return bad_input("",
                     text.data(),
                     "check the wand's tag sizes against the print, that no tag moved on "
                     "it, and that all videos start together");
  }
  return out;
}

}  // namespace marey::calib
