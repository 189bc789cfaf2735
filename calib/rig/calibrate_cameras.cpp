// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/calibrate_cameras.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "calib/bundle/refine_rig.h"
#include "calib/model/board_model.h"
#include "calib/model/board_views.h"
#include "calib/model/calibration_steps.h"
#include "calib/model/estimate_intrinsics.h"
#include "calib/model/place_cameras.h"
#include "calib/rig/ambiguous_camera.h"
#include "calib/rig/check_rig.h"
#include "calib/rig/choose_model.h"
#include "calib/rig/coarse_clocks.h"
#include "calib/rig/cross_validate.h"
#include "calib/rig/make_calibrated_rig.h"
#include "calib/rig/solve_rig.h"
#include "core/base/assert.h"

namespace marey::calib {
namespace {

/// Input and intermediate results of a calibration.
struct Work {
  std::span<const std::string> names;
  std::span<const CameraDetections> waved;
  std::span<const CameraDetections> floor;
  const CalibrationTarget* board = nullptr;
  CalibrateOptions options;
  std::vector<BoardView> views;
  std::vector<double> offsets_s;
  std::function<void()> on_iteration;
};

/// Returns true if a camera meets the preconditions of calibrate_cameras().
bool meets_preconditions(const Work& work, std::size_t c) {
  const CameraDetections& camera = work.waved[c];
  const bool needs_rate = work.options.choose_clocks || work.options.solves_clocks();
  if (needs_rate && !(camera.rate.hz > 0.0)) return false;
  if (!work.options.has_lens(c)) return true;
  const Intrinsics& k = *work.options.lenses[c];
  return k.width_px == camera.width_px && k.height_px == camera.height_px;
}

Result<std::vector<Intrinsics>> first_intrinsics(const Work& work, LensModel lens) {
  std::vector<Intrinsics> intrinsics;
  for (std::size_t c = 0; c < work.waved.size(); ++c) {
    if (work.options.has_lens(c)) {
      intrinsics.push_back(*work.options.lenses[c]);
      continue;
    }
    const CameraDetections& camera = work.waved[c];
    std::vector<const BoardView*> of_camera;
    for (const BoardView& view : work.views) {
      if (index(view.camera) == c) of_camera.push_back(&view);
    }
    const auto k =
        estimate_intrinsics(of_camera, camera.width_px, camera.height_px, lens);
    if (!k) return too_few_views(camera, *work.board);
    intrinsics.push_back(*k);
  }
  return intrinsics;
}

RefineOptions refine_options(const Work& work, const RigModel& model) {
  RefineOptions refine;
  refine.on_iteration = work.on_iteration;
  refine.shrinkage = std::holds_alternative<AprilGrid>(*work.board);
  set_unknowns(work.options, work.waved.size(), refine);
  const bool has_floor = !model.targets[0].world_from_target.empty();
  if (!has_floor) refine.fixed_camera = 0;
  return refine;
}

/// Returns the views by time: frames that are nearly simultaneous share an instant for
/// the placement of the cameras.
std::vector<BoardView> views_by_time(const Work& work) {
  std::vector<BoardView> views = work.views;
  for (BoardView& view : views) {
    if (view.instant == kFloorInstant) continue;
    const std::size_t c = index(view.camera);
    const double time_s = view.instant / work.waved[c].rate.hz + work.offsets_s[c];
    // The floor's instant is negative; the offset keeps all other instants positive.
    view.instant = static_cast<int>(
        std::lround((time_s + 2.0 * work.options.max_offset_s *
                                  static_cast<double>(work.waved.size())) *
                    work.waved[0].rate.hz));
  }
  return views;
}

/// Returns initial estimates of cameras and board poses.
Result<RigModel> first_model(Work& work, LensModel lens) {
  const auto intrinsics = first_intrinsics(work, lens);
  if (!intrinsics) return intrinsics.error();
  if (const Status ok = check_mirrored(work.views, *intrinsics); !ok) return ok.error();
  const bool is_moving = work.options.solves_clocks();
  if (is_moving && work.offsets_s.empty()) {
    work.offsets_s.assign(work.waved.size(), 0.0);
    if (work.options.solve_offsets) {
      work.offsets_s = coarse_offsets_s(
          work.views, *intrinsics, work.waved, work.options.max_offset_s);
    }
  }
  const std::vector<BoardView> views = is_moving ? views_by_time(work) : work.views;
  const auto guess =
      place_cameras(views, *intrinsics, work.names, *work.board, !work.floor.empty());
  if (!guess) return guess.error();
  if (!is_moving) return still_model(work.views, *intrinsics, *guess, *work.board);
  return moving_model(
      work.views, *intrinsics, *guess, *work.board, work.waved, work.offsets_s);
}

Result<SolvedRig> first_rig(Work& work, LensModel lens) {
  auto model = first_model(work, lens);
  if (!model) return model.error();
  SolvedRig first{std::move(*model), {}, {}};
  first.refine = refine_options(work, first.model);
  return first;
}

Result<SolvedRig> solve_board(Work work, const Clocks& clocks) {
  work.options.solve_offsets = clocks.offsets;
  work.options.solve_drifts = clocks.drifts;
  work.options.solve_line_delays = clocks.line_delays;
  const auto of_lens = [&](LensModel lens) { return first_rig(work, lens); };
  bool all_given = true;
  for (std::size_t c = 0; c < work.waved.size(); ++c) {
    all_given = all_given && work.options.has_lens(c);
  }
  const bool chooses = work.options.choose_lens && !all_given;
  auto solved = of_lens(chooses ? choose_lens(of_lens) : work.options.lens);
  if (!solved) return solved;
  solved->uncertainty = refine_rig(solved->model, solved->refine);
  if (solved->uncertainty && work.options.find_warp &&
      find_warp(solved->model, solved->refine)) {
    solved->uncertainty = refine_rig(solved->model, solved->refine);
  }
  return solved;
}

}  // namespace

Result<CalibratedRig> calibrate_cameras(std::span<const std::string> names,
                                        std::span<const CameraDetections> waved,
                                        std::span<const CameraDetections> floor,
                                        const CalibrationTarget& board,
                                        const CalibrateOptions& options) {
  MAREY_ASSERT(names.size() == waved.size());
  MAREY_ASSERT(!std::holds_alternative<Wand>(board));
  Steps steps(options.progress, calibration_steps(names.size(), options.cross_validate));
  Work work{names,
            waved,
            floor,
            &board,
            options,
            board_views(waved, floor, board),
            {},
            [&steps] { steps.tick(); }};
  for (std::size_t c = 0; c < waved.size(); ++c)
    MAREY_ASSERT(meets_preconditions(work, c));
  auto solved = solve_rig(
      names,
      waved,
      false,
      options,
      [&](const Clocks& clocks) { return solve_board(work, clocks); },
      steps);
  if (!solved) return solved.error();
  if (!solved->uncertainty) {
    return bad_input("",
                     "the bundle adjustment of the cameras does not converge",
                     "record the calibration again with the board tilted in front of "
                     "every camera");
  }
  const RigModel& model = solved->model;
  CalibratedRig rig = make_calibrated_rig(names, model, *solved->uncertainty);
  if (model.targets.size() > 1 && model.targets[1].bends) {
    rig.warp_m = model.targets[1].warp_m;
  }
  if (const Status ok = check_rig(rig, work.views, waved, floor, board); !ok)
    return ok.error();
  rig.ambiguous = ambiguous_camera(model);
  validate_rig(*solved, options, waved.front().rate.hz, steps, rig);
  return rig;
}

}  // namespace marey::calib
