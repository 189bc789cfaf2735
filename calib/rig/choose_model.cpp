// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/choose_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "calib/rig/apparent_clocks.h"
#include "calib/rig/check_rig.h"
#include "calib/rig/cross_validate.h"
#include "calib/rig/make_calibrated_rig.h"
#include "core/base/quantile.h"

namespace marey::calib {
namespace {

bool of_one_rate(std::span<const CameraDetections> waved) {
  return std::all_of(waved.begin(), waved.end(), [&](const CameraDetections& camera) {
    return std::abs(camera.rate.hz / waved.front().rate.hz - 1.0) < 1e-3;
  });
}

/// Returns the cost of all corners with a Cauchy loss at half a pixel: comparable between
/// solutions that mark different sightings as outliers.
double misfit(const CalibratedRig& rig) {
  constexpr double kTypicalPx = 0.5;
  double sum = 0.0;
  double count = 0.0;
  for (const TargetView& view : rig.views) {
    for (const SeenCorner& corner : view.corners) {
      const double e = double{glm::length(corner.error_px)} / kTypicalPx;
      sum += std::log1p(e * e);
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : 0.0;
}

/// Returns true if a camera has more outliers than wrong tags explain. Its frames may
/// have been taken at other times; while the board is at rest, some fit nevertheless.
bool has_mismatched_camera(const CalibratedRig& rig) {
  constexpr double kMaxOutliers = 0.1;
  std::vector<double> out(rig.cameras.size(), 0.0);
  std::vector<double> all(rig.cameras.size(), 0.0);
  for (const TargetView& view : rig.views) {
    if (view.stays) continue;
    for (const SeenCorner& corner : view.corners) {
      out[index(view.camera)] += corner.is_outlier ? 1.0 : 0.0;
      all[index(view.camera)] += 1.0;
    }
  }
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (out[c] > kMaxOutliers * all[c]) return true;
  }
  return false;
}

/// Tests cameras of several rates that clocks do not explain: if their frames match one
/// by one, the header of a video has a wrong rate.
std::optional<Error> rate_misstated(
    std::span<const std::string> names,
    std::span<const CameraDetections> waved,
    const CalibratedRig& by_time,
    const std::function<Result<SolvedRig>(const Clocks&)>& solve) {
  const auto by_number = solve({});
  if (!by_number || !by_number->uncertainty) return std::nullopt;
  const CalibratedRig rig = make_calibrated_rig(names, by_number->model, {});
  if (is_unusable(rig) || has_mismatched_camera(rig) ||
      (!by_time.views.empty() && misfit(rig) > 0.5 * misfit(by_time))) {
    return std::nullopt;
  }
  std::vector<double> rates;
  for (const CameraDetections& camera : waved) rates.push_back(camera.rate.hz);
  const double usual = median(rates);
  const auto other = std::find_if(waved.begin(), waved.end(), [&](const auto& camera) {
    return std::abs(camera.rate.hz / usual - 1.0) > 1e-3;
  });
  if (other == waved.end()) return std::nullopt;
  std::array<char, 160> text{};
  std::snprintf(text.data(),
                text.size(),
                "it states %.2f frames per second, but its frames match those of the "
                "other cameras (%.2f) one by one",
                other->rate.hz,
                usual);
  return bad_input(
      other->source,
      text.data(),
      "set fps for the trial in session.toml, or correct the rate in the file");
}

}  // namespace

LensModel choose_lens(const FirstModel& first_model) {
  std::optional<RigModel> best;
  LensModel chosen = LensModel::kBrownConrady;
  for (const LensModel lens :
       {LensModel::kBrownConrady, LensModel::kFisheye, LensModel::kRational}) {
    auto first = first_model(lens);
    if (!first) continue;
    RefineOptions refine = first->refine;
    refine.covariance = false;
    RigModel even = half_of(first->model, 0);
    if (!refine_rig(even, refine)) continue;
    auto tested = held_out_model(even, half_of(first->model, 1));
    if (!tested || (best && !predicts_better(*tested, *best))) continue;
    best = std::move(tested);
    chosen = lens;
  }
  return chosen;
}

Result<SolvedRig> solve_choosing_clocks(
    std::span<const std::string> names,
    std::span<const CameraDetections> waved,
    bool clocks_may_unplace,
    bool line_delays,
    const std::function<Result<SolvedRig>(const Clocks&)>& solve) {
  std::optional<Result<SolvedRig>> shared;
  bool clocks_differ = true;
  CalibratedRig shared_rig;
  // Clocks are compared without line delays, which would absorb a part of an offset.
  const auto solve_shared = [&]() {
    return line_delays ? solve({false, false, true}) : std::move(*shared);
  };
  if (of_one_rate(waved)) {
    shared = solve({});
    if (!*shared && !clocks_may_unplace) return *shared;
    if (*shared) {
      const SolvedRig& found = **shared;
      shared_rig = make_calibrated_rig(names, found.model, {});
      clocks_differ = !found.uncertainty || clocks_disagree(apparent_clocks(
                                                found.model, waved.front().rate.hz));
      if (!clocks_differ && !is_unusable(shared_rig) &&
          !has_mismatched_camera(shared_rig)) {
        return solve_shared();
      }
    }
  }
  // Over a few seconds, no clock drifts by an observable amount.
  constexpr double kLong_s = 20.0;
  const CameraDetections& first = waved.front();
  const bool is_long = static_cast<double>(first.frames.size()) / first.rate.hz > kLong_s;
  auto solved = solve({true, is_long, line_delays});
  if (!of_one_rate(waved)) {
    const bool is_solved = solved && solved->uncertainty;
    const CalibratedRig by_time =
        is_solved ? make_calibrated_rig(names, solved->model, {}) : CalibratedRig{};
    if (is_solved && !is_unusable(by_time) && !has_mismatched_camera(by_time))
      return solved;
    const auto misstated = rate_misstated(names, waved, by_time, solve);
    if (misstated) return *misstated;
  }
  if (!shared) return solved;
  if (!solved || !solved->uncertainty) return solve_shared();
  const CalibratedRig rig = make_calibrated_rig(names, solved->model, {});
  if (is_unusable(rig)) return solve_shared();
  if (!*shared || !(**shared).uncertainty) return solved;
  // Clocks do not improve the fit of a wrong board, for example; and more unknowns always
  // fit slightly better.
  const double max_misfit = (clocks_differ ? 1.0 : 0.7) * misfit(shared_rig);
  const bool is_better =
      misfit(rig) < max_misfit && rig.sightings > 0.7 * shared_rig.sightings;
  return is_better ? std::move(solved) : solve_shared();
}

}  // namespace marey::calib
