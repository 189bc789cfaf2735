// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/choose_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "calib/apparent_clocks.h"
#include "calib/check_rig.h"
#include "calib/cross_validate.h"
#include "calib/judge_rig.h"

namespace marey::calib {
namespace {

bool of_one_rate(std::span<const CameraDetections> waved) {
  return std::all_of(waved.begin(), waved.end(), [&](const CameraDetections& camera) {
    return std::abs(camera.rate.hz / waved.front().rate.hz - 1.0) < 1e-3;
  });
}

/// Whether cameras that were taken for simultaneous are.
bool go_together(std::span<const std::string> names,
                 std::span<const CameraDetections> waved,
                 const SolvedRig& shared) {
  const CalibratedRig rig = judge_rig(names, shared.model, {});
  // Of frames that do not go together, those in which the board rests remain.
  const bool most_fit = rig.outliers < 0.2 * rig.sightings;
  return !is_hopeless(rig) && most_fit &&
         !run_apart(apparent_clocks(shared.model, waved.front().rate.hz));
}

}  // namespace

LensModel choose_lens(const FirstModel& first_model) {
  LensModel best = LensModel::kBrownConrady;
  double least = 0.0;
  for (const LensModel lens :
       {LensModel::kBrownConrady, LensModel::kFisheye, LensModel::kRational}) {
    auto first = first_model(lens);
    if (!first) continue;
    RefineOptions refine = first->refine;
    refine.covariance = false;
    RigModel even = half_of(first->model, 0);
    if (!refine_rig(even, refine)) continue;
    const auto rms_px = held_out_rms_px(even, half_of(first->model, 1));
    if (rms_px && (least == 0.0 || *rms_px < 0.98 * least)) {
      least = *rms_px;
      best = lens;
    }
  }
  return best;
}

Result<SolvedRig> solve_choosing_clocks(
    std::span<const std::string> names,
    std::span<const CameraDetections> waved,
    bool clocks_may_unplace,
    const std::function<Result<SolvedRig>(const Clocks&)>& solve) {
  std::optional<Result<SolvedRig>> shared;
  if (of_one_rate(waved)) {
    shared = solve({});
    if (!*shared && !clocks_may_unplace) return *shared;
    if (*shared && (**shared).doubt && go_together(names, waved, **shared)) {
      return *shared;
    }
  }
  // Within seconds no clock drifts by what could be seen.
  constexpr double kLong_s = 20.0;
  const CameraDetections& first = waved.front();
  const bool is_long = static_cast<double>(first.frames.size()) / first.rate.hz > kLong_s;
  auto solved = solve({true, is_long});
  if (!shared) return solved;
  if (!solved || !solved->doubt) return *shared;
  const CalibratedRig rig = judge_rig(names, solved->model, {});
  if (is_hopeless(rig)) return *shared;
  if (!*shared || !(**shared).doubt) return solved;
  // Of a wrong board, say, clocks make nothing better.
  const double shared_px = judge_rig(names, (**shared).model, {}).inlier_rms_px;
  return rig.inlier_rms_px < shared_px ? std::move(solved) : std::move(*shared);
}

}  // namespace marey::calib
