// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/calibrate_wand.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "calib/bundle/refine_rig.h"
#include "calib/model/calibration_steps.h"
#include "calib/model/place_cameras.h"
#include "calib/model/planar_pose.h"
#include "calib/model/rig_model.h"
#include "calib/model/wand_model.h"
#include "calib/rig/check_rig.h"
#include "calib/rig/choose_model.h"
#include "calib/rig/coarse_clocks.h"
#include "calib/rig/make_calibrated_rig.h"
#include "calib/rig/place_tags.h"
#include "calib/rig/solve_rig.h"
#include "core/base/assert.h"
#include "core/base/quantile.h"

namespace marey::calib {
namespace {

/// Input and options of a calibration.
struct WandWork {
  std::span<const std::string> names;
  std::span<const CameraDetections> waved;
  const Wand* wand = nullptr;
  WandOptions options;
  std::function<void()> on_iteration;
};

/// Fills in initial intrinsics. A camera without an estimate starts with those of the
/// cameras of its image size, or of any camera.
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
    const bool is_given = options.has_lens(c);
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
    if (options.has_lens(c)) {
      k = *options.lenses[c];
      continue;
    }
    k.centre_px = {0.5 * (k.width_px - 1), 0.5 * (k.height_px - 1)};
    k.focal_px = glm::dvec2(usual * k.width_px);
    if (!found[c]) continue;
    // A focal length from few single tags is accurate to about a tenth: cameras of one
    // size probably have the same lens.
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
                   "no shared sighting connects the cameras "
                   "{" +
                       reached + "} and {" + missed +
                       "}: both groups see the wand together at too few instants",
                   "record the calibration again and carry the wand through where both "
                   "groups see it");
}

WandCalibration to_calibration(std::span<const std::string> names,
                               const RigModel& model,
                               const RigUncertainty& uncertainty) {
  WandCalibration out;
  out.rig = make_calibrated_rig(names, model, uncertainty);
  for (const Piece& piece : model.targets[kWand].pieces) {
    if (piece.is_placed) out.wand_from_tag[piece.id] = piece.target_from_piece;
  }
  for (const RigidTarget& target : model.targets) {
    if (!target.stays) continue;
    for (const Piece& piece : target.pieces) {
      if (piece.is_placed) out.static_tag_sizes_m[piece.id] = piece.size_m;
    }
  }
  if (model.targets[kWand].knot_spacing_s <= 0.0) {
    out.world_from_wand = model.targets[kWand].world_from_target;
  }
  return out;
}

/// Returns each tag's poses in each camera: the better of the two planar solutions.
std::vector<SeenTrack> tracks_of(const RigModel& model) {
  std::vector<SeenTrack> tracks(model.cameras.size());
  const auto& pieces = model.targets[kWand].pieces;
  for (const Sighting& s : model.sightings) {
    if (s.target != kWand) continue;
    std::array<glm::dvec3, 4> corners{};
    std::array<glm::dvec2, 4> pixels_px{};
    for (std::size_t i = 0; i < 4; ++i) {
      corners[i] = pieces[s.piece].size_m * s.corners[i].p_in_board;
      pixels_px[i] = s.corners[i].pixel_px;
    }
    const auto placed =
        place_plane(model.cameras[s.camera].intrinsics, corners, pixels_px);
    if (placed.empty()) continue;
    tracks[s.camera][{s.piece, s.frame}] = placed.front().camera_from_plane;
  }
  return tracks;
}

/// Returns initial estimates of the cameras and of the wand's poses.
Result<SolvedRig> first_rig(const WandWork& work, LensModel lens) {
  WandOptions options = work.options;
  options.lens = lens;
  RigModel model = wand_at_instants(work.waved, *work.wand, options, {});
  if (model.targets[kWand].pieces.empty()) {
    return bad_input("",
                     "no tag of the wand is seen by any camera",
                     "check the ids of the wand's tags and the tag family in "
                     "session.toml against the print");
  }
  if (!start_lenses(model, options)) {
    return bad_input("",
                     "there are too few views of the wand to estimate the lens of any "
                     "camera",
                     "record the calibration again: carry the wand through the whole "
                     "volume, near and far, and turn it");
  }
  const bool is_moving = options.solves_clocks();
  std::vector<double> offsets_s(work.waved.size(), 0.0);
  if (options.solve_offsets) {
    offsets_s = coarse_offsets_s(tracks_of(model), work.waved, options.max_offset_s);
  }
  if (is_moving) {
    RigModel by_time = wand_at_instants(work.waved, *work.wand, options, offsets_s);
    for (std::size_t c = 0; c < model.cameras.size(); ++c) {
      by_time.cameras[c].intrinsics = model.cameras[c].intrinsics;
    }
    model = std::move(by_time);
  }
  const std::vector<bool> placed = place_by_tags(model);
  if (std::find(placed.begin(), placed.end(), false) != placed.end()) {
    return not_connected(work.names, placed);
  }
  if (is_moving) model = wand_in_motion(std::move(model), work.waved, offsets_s);
  SolvedRig first{std::move(model), {}, {}};
  first.refine.on_iteration = work.on_iteration;
  first.refine.fixed_camera = 0;
  set_unknowns(options, work.waved.size(), first.refine);
  return first;
}

Result<SolvedRig> solve_wand(WandWork work, const Clocks& clocks) {
  work.options.solve_offsets = clocks.offsets;
  work.options.solve_drifts = clocks.drifts;
  work.options.solve_line_delays = clocks.line_delays;
  const auto of_lens = [&](LensModel lens) { return first_rig(work, lens); };
  auto solved =
      of_lens(work.options.choose_lens ? choose_lens(of_lens) : work.options.lens);
  if (solved) solved->uncertainty = refine_rig(solved->model, solved->refine);
  return solved;
}

Error too_far_off(const CalibratedRig& rig) {
  std::array<char, 120> text{};
  std::snprintf(text.data(),
                text.size(),
                "the error of the calibration is %.1f px (good: under 0.5)",
                rig.median_px);
  return bad_input("",
                   text.data(),
                   "check the wand's tag sizes against the print, that no tag moved on "
                   "it, and, with clocks = \"shared\", that all videos start together");
}

}  // namespace

Result<WandCalibration> calibrate_wand(std::span<const std::string> names,
                                       std::span<const CameraDetections> waved,
                                       const Wand& wand,
                                       const WandOptions& options) {
  MAREY_ASSERT(names.size() == waved.size() && !wand.tags.empty());
  Steps steps(options.progress, calibration_steps(names.size(), options.cross_validate));
  const WandWork work{names, waved, &wand, options, [&steps] { steps.tick(); }};
  auto solved = solve_rig(
      names,
      waved,
      true,
      options,
      [&](const Clocks& clocks) { return solve_wand(work, clocks); },
      steps);
  if (!solved) return solved.error();
  if (!solved->uncertainty) {
    return bad_input("",
                     "the bundle adjustment of the cameras does not converge",
                     "record the calibration again: carry the wand through the whole "
                     "volume and turn it");
  }
  RigModel& model = solved->model;
  move_model(world_from_upright_camera() * inverse(model.cameras[0].world_from_camera),
             model,
             *solved->uncertainty);
  WandCalibration out = to_calibration(names, model, *solved->uncertainty);
  if (is_unusable(out.rig)) return too_far_off(out.rig);
  validate_rig(*solved, options, waved.front().rate.hz, steps, out.rig);
  return out;
}

}  // namespace marey::calib
