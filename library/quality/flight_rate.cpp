// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/flight_rate.h"

#include <algorithm>
#include <cmath>

namespace marey::library {
namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr double kOffFloor_m = 0.02;
constexpr int kMinFlightFrames = 5;
constexpr double kMinSagitta_m = 0.025;
constexpr double kMaxResidual = 0.08;

// Least squares of y = a + b u + c (u^2 - mean u^2) over u = -h..h, whose terms are
// orthogonal.
std::optional<FreeFall> fit_fall(const QualityFrames& frames, int first, int last) {
  // A tenth at either end may belong to the contacts.
  const int trim = (last - first + 1) / 10;
  first += trim;
  last -= trim;
  const double middle = 0.5 * (first + last);
  double n = 0.0;
  double y1 = 0.0;
  double u2 = 0.0;
  double u4 = 0.0;
  double uy = 0.0;
  double u2y = 0.0;
  for (int t = first; t <= last; ++t) {
    const double u = t - middle;
    const double y = frames.com_in_world[static_cast<std::size_t>(t)].y;
    n += 1.0;
    y1 += y;
    u2 += u * u;
    u4 += u * u * u * u;
    uy += u * y;
    u2y += u * u * y;
  }
  const double bend = u4 - u2 * u2 / n;
  if (n < 4.0 || bend <= 0.0) return std::nullopt;
  const double c = (u2y - u2 * y1 / n) / bend;
  const double a = y1 / n - c * u2 / n;
  const double b = uy / u2;
  double squares = 0.0;
  for (int t = first; t <= last; ++t) {
    const double u = t - middle;
    const double r =
        frames.com_in_world[static_cast<std::size_t>(t)].y - (a + b * u + c * u * u);
    squares += r * r;
  }
  const double half = 0.5 * (last - first);
  const double sagitta_m = -c * half * half;
  if (sagitta_m < kMinSagitta_m) return std::nullopt;
  if (std::sqrt(squares / n) > kMaxResidual * sagitta_m) return std::nullopt;
  return FreeFall{{first, last}, -2.0 * c * frames.hz * frames.hz};
}

}  // namespace

std::vector<FreeFall> find_free_falls(const QualityFrames& frames) {
  std::vector<FreeFall> falls;
  std::vector<double> lower_m(static_cast<std::size_t>(frames.count));
  const auto lower = [&](std::size_t t) {
    return std::min(frames.sole_m[0][t], frames.sole_m[1][t]);
  };
  for (std::size_t t = 0; t < lower_m.size(); ++t) lower_m[t] = lower(t);
  const double off_m = quantile_in_place(lower_m, 0.05) + kOffFloor_m;
  for (int t = 0; t < frames.count; ++t) {
    const int first = t;
    while (t < frames.count && lower(static_cast<std::size_t>(t)) > off_m) ++t;
    // A flight that the motion cuts may be anything.
    if (t - first < kMinFlightFrames || first == 0 || t == frames.count) continue;
    if (const auto fall = fit_fall(frames, first, t - 1)) falls.push_back(*fall);
  }
  return falls;
}

std::array<FoundFigure, 2> measure_flight_rate(const QualityFrames& frames,
                                               const QualityLimits& limits) {
  FoundFigure ratio{"rate_ratio"};
  FoundFigure flights{"flights"};
  const std::vector<FreeFall> falls = find_free_falls(frames);
  flights.value = static_cast<double>(falls.size());
  if (falls.size() < 2) return {ratio, flights};
  std::vector<double> gravity;
  for (const FreeFall& fall : falls) gravity.push_back(fall.gravity_m_s2);
  const double share = quantile_in_place(gravity, 0.5) / kGravity_m_s2;
  ratio.value = std::max(share, 1.0 / share);
  if (ratio.value > limits["rate_ratio"].warn) {
    ratio.frames = FrameRange{0, frames.count - 1};
    for (const FreeFall& fall : falls) {
      const double own = fall.gravity_m_s2 / kGravity_m_s2;
      ratio.places.push_back({fall.frames, std::nullopt, std::max(own, 1.0 / own)});
    }
  }
  return {std::move(ratio), std::move(flights)};
}

}  // namespace marey::library
