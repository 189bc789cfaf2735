// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/calibrate_cameras.h"

#include <algorithm>
#include <cmath>

#include "calib/board_model.h"
#include "calib/board_views.h"
#include "calib/check_rig.h"
#include "calib/coarse_clocks.h"
#include "calib/cross_validate.h"
#include "calib/estimate_intrinsics.h"
#include "calib/judge_rig.h"
#include "calib/place_cameras.h"
#include "calib/refine_rig.h"
#include "core/assert.h"

namespace marey::calib {
namespace {

/// What the recording says, and what is made of it.
struct Work {
  std::span<const std::string> names;
  std::span<const CameraDetections> waved;
  std::span<const CameraDetections> floor;
  const CalibrationTarget* board = nullptr;
  CalibrateOptions options;
  std::vector<BoardView> views;
  std::vector<double> offsets_s;
};

Result<std::vector<Intrinsics>> first_intrinsics(const Work& work, LensModel lens) {
  std::vector<Intrinsics> intrinsics;
  for (std::size_t c = 0; c < work.waved.size(); ++c) {
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
  refine.shrinkage = std::holds_alternative<AprilGrid>(*work.board);
  refine.offsets = work.options.solve_offsets;
  refine.drifts = work.options.solve_drifts;
  refine.line_delays = work.options.solve_line_delays;
  const bool has_floor = !model.targets[0].world_from_target.empty();
  if (!has_floor) refine.fixed_camera = 0;
  return refine;
}

/// Cameras and boards as a first guess has them.
Result<RigModel> first_model(Work& work, LensModel lens) {
  const auto intrinsics = first_intrinsics(work, lens);
  if (!intrinsics) return intrinsics.error();
  if (const Status ok = check_mirrored(work.views, *intrinsics); !ok) return ok.error();
  std::vector<BoardView> views = work.views;
  if (work.options.solve_offsets) {
    if (work.offsets_s.empty()) {
      work.offsets_s = coarse_offsets_s(
          work.views, *intrinsics, work.waved, work.options.most_offset_s);
    }
    // Frames that are nearly simultaneous share an instant while cameras are placed.
    for (BoardView& view : views) {
      if (view.instant == kFloorInstant) continue;
      const std::size_t c = index(view.camera);
      const double time_s = view.instant / work.waved[c].rate.hz + work.offsets_s[c];
      // The floor's instant is below zero: times start well above.
      view.instant = static_cast<int>(
          std::lround((time_s + 2.0 * work.options.most_offset_s *
                                    static_cast<double>(work.waved.size())) *
                      work.waved[0].rate.hz));
    }
  }
  const auto guess =
      place_cameras(views, *intrinsics, work.names, *work.board, !work.floor.empty());
  if (!guess) return guess.error();
  if (!work.options.solve_offsets) {
    return still_model(work.views, *intrinsics, *guess, *work.board);
  }
  return moving_model(
      work.views, *intrinsics, *guess, *work.board, work.waved, work.offsets_s);
}

/// Of all lenses, the one that does best on frames it did not see; the simpler one unless
/// it is beaten by two percent: five terms before four of another kind, before eight.
LensModel choose_lens(Work& work) {
  LensModel best = LensModel::kBrownConrady;
  double least = 0.0;
  for (const LensModel lens :
       {LensModel::kBrownConrady, LensModel::kFisheye, LensModel::kRational}) {
    auto model = first_model(work, lens);
    if (!model) continue;
    RefineOptions refine = refine_options(work, *model);
    refine.covariance = false;
    RigModel even = half_of(*model, 0);
    if (!refine_rig(even, refine)) continue;
    const auto rms_px = held_out_rms_px(even, half_of(*model, 1));
    if (rms_px && (least == 0.0 || *rms_px < 0.98 * least)) {
      least = *rms_px;
      best = lens;
    }
  }
  return best;
}

}  // namespace

Result<CalibratedRig> calibrate_cameras(std::span<const std::string> names,
                                        std::span<const CameraDetections> waved,
                                        std::span<const CameraDetections> floor,
                                        const CalibrationTarget& board,
                                        const CalibrateOptions& options) {
  MAREY_ASSERT(names.size() == waved.size());
  MAREY_ASSERT(!std::holds_alternative<Wand>(board));
  Work work{names, waved, floor, &board, options, board_views(waved, floor, board), {}};
  const LensModel lens = options.choose_lens ? choose_lens(work) : options.lens;
  auto model = first_model(work, lens);
  if (!model) return model.error();
  const RefineOptions refine = refine_options(work, *model);
  const auto no_minimum = [] {
    return bad_input("",
                     "the bundle adjustment of the cameras does not converge",
                     "record the calibration again with the board tilted in front of "
                     "every camera");
  };
  auto doubt = refine_rig(*model, refine);
  if (!doubt) return no_minimum();
  if (options.find_warp && find_warp(*model, refine)) {
    doubt = refine_rig(*model, refine);
    if (!doubt) return no_minimum();
  }
  CalibratedRig rig = judge_rig(names, *model, *doubt);
  if (model->targets.size() > 1 && model->targets[1].bends) {
    rig.warp_m = model->targets[1].warp_m;
  }
  if (const Status ok = check_rig(rig, work.views, floor, board); !ok) return ok.error();
  if (options.cross_validate) rig.cross_validation = cross_validate(*model, refine);
  return rig;
}

}  // namespace marey::calib
