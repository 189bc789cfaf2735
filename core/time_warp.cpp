// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/time_warp.h"

#include <algorithm>
#include <cstddef>

#include "core/base/assert.h"

namespace marey {

/// An interval between two knots, and the share of it that has passed.
struct TimeWarp::Place {
  std::size_t before = 0;
  double length_s = 0.0;
  double mean_speed = 0.0;
  double x = 0.0;
};

TimeWarp::TimeWarp(std::span<const WarpKnot> knots, std::optional<double> outer_speed)
    : knots_(knots.begin(), knots.end()) {
  MAREY_ASSERT(!knots_.empty());
  std::vector<double> mean;
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    const double time_s = knots_[i].time_s - knots_[i - 1].time_s;
    const double source_s = knots_[i].source_s - knots_[i - 1].source_s;
    MAREY_ASSERT(time_s > 0.0 && source_s > 0.0);
    mean.push_back(source_s / time_s);
  }
  if (mean.empty()) {
    speed_ = {1.0};
    return;
  }
  // A quintic is monotone up to 2.14 times the mean speed.
  constexpr double kMostOfMean = 2.1;
  const auto outer = [&](double mean_speed) {
    return std::min(outer_speed.value_or(mean_speed), kMostOfMean * mean_speed);
  };
  speed_.push_back(outer(mean.front()));
  for (std::size_t i = 1; i < mean.size(); ++i) {
    const double a = mean[i - 1];
    const double b = mean[i];
    speed_.push_back(a == b ? a : 2.0 * a * b / (a + b));
  }
  speed_.push_back(outer(mean.back()));
}

TimeWarp::Place TimeWarp::find(double time_s) const {
  const auto after = std::upper_bound(
      knots_.begin(), knots_.end(), time_s, [](double time, const WarpKnot& knot) {
        return time < knot.time_s;
      });
  const auto before = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
      after - knots_.begin() - 1, 0, static_cast<std::ptrdiff_t>(knots_.size()) - 2));
  const WarpKnot& a = knots_[before];
  const WarpKnot& b = knots_[before + 1];
  const double length_s = b.time_s - a.time_s;
  return {before,
          length_s,
          (b.source_s - a.source_s) / length_s,
          (time_s - a.time_s) / length_s};
}

double TimeWarp::source_s(double time_s) const {
  if (time_s <= knots_.front().time_s) {
    return knots_.front().source_s + speed_.front() * (time_s - knots_.front().time_s);
  }
  if (time_s >= knots_.back().time_s) {
    return knots_.back().source_s + speed_.back() * (time_s - knots_.back().time_s);
  }
  const Place at = find(time_s);
  const double m0 = speed_[at.before];
  const double m1 = speed_[at.before + 1];
  const double source_s = knots_[at.before].source_s;
  // On a line the polynomial would add rounding errors.
  if (m0 == at.mean_speed && m1 == at.mean_speed) {
    return source_s + m0 * at.length_s * at.x;
  }
  const double x = at.x;
  const double x3 = x * x * x;
  return source_s + at.length_s * (m0 * (x + x3 * (-6.0 + x * (8.0 - 3.0 * x))) +
                                   m1 * x3 * (-4.0 + x * (7.0 - 3.0 * x)) +
                                   at.mean_speed * x3 * (10.0 + x * (-15.0 + 6.0 * x)));
}

double TimeWarp::speed(double time_s) const {
  if (time_s <= knots_.front().time_s) return speed_.front();
  if (time_s >= knots_.back().time_s) return speed_.back();
  const Place at = find(time_s);
  const double x = at.x;
  const double x2 = x * x;
  return speed_[at.before] * (1.0 + x2 * (-18.0 + x * (32.0 - 15.0 * x))) +
         speed_[at.before + 1] * x2 * (-12.0 + x * (28.0 - 15.0 * x)) +
         at.mean_speed * x2 * (30.0 + x * (-60.0 + 30.0 * x));
}

}  // namespace marey
