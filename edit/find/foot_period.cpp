// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/find/foot_period.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/assert.h"
#include "core/pose.h"
#include "core/transform.h"

namespace marey::edit {
namespace {

constexpr double kMaxHeightRate_hz = 60.0;
constexpr double kWholeMotion_s = 8.0;  ///< Longer motions are searched in windows.
constexpr double kWindow_s = 6.0;
constexpr double kMinPeriod_s = 0.25;
constexpr double kMinOverlap_s = 0.3;
constexpr double kMinCorrelation = 0.6;
/// A peak this close to the highest one is preferred if its period is shorter: two cycles
/// may correlate better than one.
constexpr double kAsHigh = 0.75;
/// Ankles of a walking body vary by 0.04 legs; a standing one sways by less than this.
constexpr double kMinDeviation_legs = 0.008;

using Heights = std::array<std::vector<double>, 2>;

struct HeightSums {
  double product = 0.0;
  double square_a = 0.0;
  double square_b = 0.0;
};

void add_side(std::span<const double> heights, std::size_t lag, HeightSums& sums) {
  const std::size_t count = heights.size() - lag;
  double mean_a = 0.0;
  double mean_b = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    mean_a += heights[k];
    mean_b += heights[k + lag];
  }
  mean_a /= static_cast<double>(count);
  mean_b /= static_cast<double>(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double a = heights[k] - mean_a;
    const double b = heights[k + lag] - mean_b;
    sums.product += a * b;
    sums.square_a += a * a;
    sums.square_b += b * b;
  }
}

double deviation_m(const Heights& heights, std::size_t first, std::size_t count) {
  HeightSums sums;
  for (const auto& side : heights) add_side({side.data() + first, count}, 0, sums);
  return std::sqrt(sums.square_a / static_cast<double>(2 * count));
}

double correlation(const Heights& heights,
                   std::size_t first,
                   std::size_t count,
                   std::size_t lag) {
  HeightSums sums;
  for (const auto& side : heights) add_side({side.data() + first, count}, lag, sums);
  const double scale = std::sqrt(sums.square_a * sums.square_b);
  return scale > 0.0 ? sums.product / scale : 0.0;
}

std::optional<FootPeriod> first_high_peak(const std::vector<double>& values,
                                          std::size_t first_lag,
                                          double hz) {
  std::vector<std::size_t> peaks;
  double highest = kMinCorrelation;
  for (std::size_t k = 1; k + 1 < values.size(); ++k) {
    if (values[k] < values[k - 1] || values[k] <= values[k + 1]) continue;
    peaks.push_back(k);
    highest = std::max(highest, values[k]);
  }
  for (const std::size_t k : peaks) {
    if (values[k] < std::max(kMinCorrelation, kAsHigh * highest)) continue;
    const double bend = values[k - 1] - 2.0 * values[k] + values[k + 1];
    const double off = bend < 0.0 ? 0.5 * (values[k - 1] - values[k + 1]) / bend : 0.0;
    return FootPeriod{(static_cast<double>(first_lag + k) + off) / hz, values[k], 0.0};
  }
  return std::nullopt;
}

std::optional<FootPeriod> period_in_window(const Heights& heights,
                                           std::size_t first,
                                           std::size_t count,
                                           double hz,
                                           double min_deviation_m) {
  const double deviation = deviation_m(heights, first, count);
  if (deviation < min_deviation_m) return std::nullopt;
  const auto first_lag =
      static_cast<std::size_t>(std::max(1.0, std::floor(kMinPeriod_s * hz)));
  const auto overlap = static_cast<std::size_t>(std::ceil(kMinOverlap_s * hz));
  std::vector<double> values;
  for (std::size_t lag = first_lag; lag + std::max(overlap, lag / 2) <= count; ++lag) {
    values.push_back(correlation(heights, first, count, lag));
  }
  auto found = first_high_peak(values, first_lag, hz);
  if (found) found->deviation_m = deviation;
  return found;
}

}  // namespace

std::array<std::vector<double>, 2> ankle_heights(const Motion& motion,
                                                 const retarget::BodyMap& map,
                                                 const FrameRange& frames,
                                                 int stride) {
  Heights heights;
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  for (int frame = frames.first; frame <= frames.last; frame += stride) {
    world_from_joints(
        motion.skeleton, motion.poses[static_cast<std::size_t>(frame)], world);
    for (int side = 0; side < 2; ++side) {
      heights[static_cast<std::size_t>(side)].push_back(
          world[index(map.leg(side).end)].translation.y);
    }
  }
  return heights;
}

std::optional<FootPeriod> foot_period(const Motion& motion,
                                      const retarget::BodyMap& map,
                                      const FrameRange& frames) {
  MAREY_ASSERT(frames.first >= 0 && frames.first <= frames.last &&
               frames.last < static_cast<int>(motion.poses.size()));
  const int stride =
      std::max(1, static_cast<int>(std::lround(motion.rate.hz / kMaxHeightRate_hz)));
  const double hz = motion.rate.hz / stride;
  const Heights heights = ankle_heights(motion, map, frames, stride);
  const std::size_t total = heights[0].size();
  const double min_deviation_m = kMinDeviation_legs * map.leg_length_m;
  if (static_cast<double>(total) <= kWholeMotion_s * hz) {
    return period_in_window(heights, 0, total, hz, min_deviation_m);
  }
  const auto window = static_cast<std::size_t>(kWindow_s * hz);
  std::optional<FootPeriod> best;
  for (std::size_t first = 0; first + window <= total; first += window / 2) {
    const auto found = period_in_window(heights, first, window, hz, min_deviation_m);
    if (found && (!best || found->correlation > best->correlation)) best = found;
  }
  return best;
}

}  // namespace marey::edit
