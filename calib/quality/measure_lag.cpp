// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/quality/measure_lag.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include <glm/geometric.hpp>

#include "core/base/quantile.h"

namespace marey::calib {
namespace {

/// Sums for a straight line through zero and its residuals.
struct Line {
  double squares = 0.0;
  double products = 0.0;
  double errors = 0.0;

  void add(const PassingView& view) {
    squares += glm::dot(view.velocity_px, view.velocity_px);
    products += glm::dot(view.velocity_px, view.error_px);
    errors += glm::dot(view.error_px, view.error_px);
  }
  [[nodiscard]] double slope() const { return squares > 0.0 ? products / squares : 0.0; }
  [[nodiscard]] double left() const { return errors - slope() * products; }
};

Line operator-(const Line& a, const Line& b) {
  return {a.squares - b.squares, a.products - b.products, a.errors - b.errors};
}

}  // namespace

std::vector<PassingView> passing_views(const CalibrationReport& report,
                                       const Camera& camera,
                                       const std::vector<const TargetView*>& views) {
  constexpr int kMaxGap_frames = 3;  // Frames between neighbours for a velocity.
  std::vector<PassingView> out;
  if (views.empty()) return out;
  const glm::dvec3 middle =
      report.extent ? 0.5 * (report.extent->min_in_board + report.extent->max_in_board)
                    : glm::dvec3(0.0);
  std::set<int> others;
  for (const TargetView& view : report.rig.views) {
    if (!view.stays && view.camera != views.front()->camera) others.insert(view.frame);
  }
  for (std::size_t i = 1; i + 1 < views.size(); ++i) {
    const TargetView& before = *views[i - 1];
    const TargetView& after = *views[i + 1];
    if (views[i]->frame - before.frame > kMaxGap_frames ||
        after.frame - views[i]->frame > kMaxGap_frames) {
      continue;
    }
    const auto from = project(camera, before.world_from_target * middle);
    const auto to = project(camera, after.world_from_target * middle);
    if (!from || !to) continue;
    std::vector<double> xs;
    std::vector<double> ys;
    for (const SeenCorner& corner : views[i]->corners) {
      xs.push_back(corner.error_px.x);
      ys.push_back(corner.error_px.y);
    }
    out.push_back({views[i]->frame,
                   (*to - *from) / static_cast<double>(after.frame - before.frame),
                   {median(std::move(xs)), median(std::move(ys))},
                   others.contains(views[i]->frame)});
  }
  return out;
}

std::optional<CameraLag> lag_of(const std::vector<PassingView>& views) {
  constexpr std::size_t kMin = 10;
  Line line;
  for (const PassingView& view : views) line.add(view);
  if (views.size() < kMin || !(line.squares > 0.0)) return std::nullopt;
  CameraLag lag;
  // Seen minus expected: a late camera sees the board further along.
  lag.frames = line.slope();
  double left = 0.0;
  for (const PassingView& view : views) {
    const glm::dvec2 rest = view.error_px - lag.frames * view.velocity_px;
    left += glm::dot(rest, rest);
  }
  const auto n = static_cast<double>(views.size());
  lag.sigma_frames = std::sqrt(left / (2.0 * n - 1.0) / line.squares);
  lag.explained_px = std::abs(lag.frames) * std::sqrt(line.squares / n);
  return lag;
}

std::optional<CameraSlip> slip_of(const std::vector<PassingView>& views) {
  // Views that no other camera shares do not constrain the clock; two shared frames may
  // be the only ones. The motion must then explain nearly the whole error.
  constexpr std::size_t kMin = 2;
  constexpr std::size_t kFew = 5;
  constexpr double kMaxLeftOfFew = 0.3;
  constexpr double kMaxLeft = 0.6;
  constexpr double kMinLag_frames = 0.3;
  // Errors of neighbouring views are correlated, and the best of many positions is
  // selected.
  constexpr double kMinSigmas = 7.0;
  std::vector<PassingView> shared;
  std::copy_if(views.begin(), views.end(), std::back_inserter(shared), [](const auto& v) {
    return v.is_shared;
  });
  if (shared.size() < 2 * kFew) return std::nullopt;
  Line all;
  for (const PassingView& view : shared) all.add(view);
  std::optional<CameraSlip> best;
  double minimum = all.left();
  Line before;
  for (std::size_t i = 0; i + kMin <= shared.size(); ++i) {
    const Line after = all - before;
    const double left = before.left() + after.left();
    const bool is_few = i < kFew || i + kFew > shared.size();
    const double maximum = is_few ? kMaxLeftOfFew : kMaxLeft;
    if (i >= kMin && left < minimum && left < maximum * all.left()) {
      minimum = left;
      best = CameraSlip{shared[i].frame,
                        after.slope() - before.slope(),
                        std::abs(after.slope() - before.slope()) *
                            std::sqrt(all.squares / static_cast<double>(shared.size()))};
    }
    before.add(shared[i]);
  }
  const double noise =
      std::max(0.0, minimum) / (2.0 * static_cast<double>(shared.size()) - 2.0);
  if (!best || std::abs(best->frames) < kMinLag_frames ||
      all.left() - minimum < kMinSigmas * kMinSigmas * noise) {
    return std::nullopt;
  }
  return best;
}

}  // namespace marey::calib
