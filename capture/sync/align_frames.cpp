// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/sync/align_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "capture/sync/group_frames.h"
#include "core/base/assert.h"

namespace marey::capture {
namespace {

double ns(Timestamp time) {
  return static_cast<double>(time.count());
}

std::vector<double> steps_ns(std::span<const Timestamp> times) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) {
    steps.push_back(ns(times[i] - times[i - 1]));
  }
  return steps;
}

/// Returns the time per frame, missing frames included. Each frame number is predicted
/// from the smoothed times before it, so that jitter does not accumulate.
double counted_period(std::span<const Timestamp> times, double period_ns) {
  constexpr double kMinGain = 0.1;
  double number = 0.0;
  double expected = 0.0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double t = ns(times[i] - times[0]);
    const double steps = std::max(1.0, std::round((t - expected) / period_ns));
    number += steps;
    expected += steps * period_ns;
    expected += std::max(kMinGain, 1.0 / static_cast<double>(i + 1)) * (t - expected);
  }
  return ns(times.back() - times[0]) / number;
}

/// Returns the mean lag of `times` behind the grid, within half a period: a circular
/// mean, since a lag of a whole period is equivalent to none.
double mean_lag_ns(std::span<const Timestamp> times, Timestamp origin, double period_ns) {
  const double turn = 2.0 * std::numbers::pi;
  double x = 0.0;
  double y = 0.0;
  for (const Timestamp time : times) {
    const double angle = turn * std::remainder(ns(time - origin), period_ns) / period_ns;
    x += std::cos(angle);
    y += std::sin(angle);
  }
  return std::atan2(y, x) / turn * period_ns;
}

/// Returns the coherence of `times` with a period: 1 for perfectly periodic, 0 for
/// random.
double coherence(std::span<const Timestamp> times, double period_ns) {
  double x = 0.0;
  double y = 0.0;
  for (const Timestamp time : times) {
    const double angle = 2.0 * std::numbers::pi * ns(time - times[0]) / period_ns;
    x += std::cos(angle);
    y += std::sin(angle);
  }
  return std::hypot(x, y) / static_cast<double>(times.size());
}

/// Returns the period near `guess_ns` with the highest coherence. The search range covers
/// the error of a guess with one wrongly counted frame.
double best_period(std::span<const Timestamp> times, double guess_ns) {
  constexpr double kMaxTurns = 40.0;  // Error of the guess in periods, over all frames.
  constexpr double kMaxShare = 0.03;
  constexpr double kStepsPerTurn = 5.0;
  const double turns = (ns(times.back() - times[0])) / guess_ns;
  const double reach = std::min(kMaxShare, kMaxTurns / turns);
  const double step = 1.0 / (kStepsPerTurn * turns);
  double best_ns = guess_ns;
  double best = 0.0;
  const int steps = static_cast<int>(reach / step);
  for (int i = -steps; i <= steps; ++i) {
    const double period_ns = guess_ns * (1.0 + i * step);
    const double found = coherence(times, period_ns);
    if (found <= best) continue;
    best = found;
    best_ns = period_ns;
  }
  return best_ns;
}

/// Returns the slope of times over the numbers of the nearest instants.
double slope_ns(std::span<const Timestamp> times, double period_ns) {
  const double lag_ns = mean_lag_ns(times, times[0], period_ns);
  double sum_n = 0.0;
  double sum_t = 0.0;
  double sum_nn = 0.0;
  double sum_nt = 0.0;
  for (const Timestamp time : times) {
    const double t = ns(time - times[0]);
    const double number = std::round((t - lag_ns) / period_ns);
    sum_n += number;
    sum_t += t;
    sum_nn += number * number;
    sum_nt += number * t;
  }
  const auto count = static_cast<double>(times.size());
  const double spread = count * sum_nn - sum_n * sum_n;
  return spread > 0.0 ? (count * sum_nt - sum_n * sum_t) / spread : 0.0;
}

std::optional<FrameRate> fastest(std::span<const CameraTimes> cameras) {
  constexpr double kSame = 0.01;
  std::vector<double> rates_hz;
  for (const CameraTimes& camera : cameras) {
    if (const auto rate = measured_rate(camera.times)) rates_hz.push_back(rate->hz);
  }
  if (rates_hz.empty()) return std::nullopt;
  std::sort(rates_hz.begin(), rates_hz.end());
  const double minimum = rates_hz.back() * (1.0 - kSame);
  const auto first = std::lower_bound(rates_hz.begin(), rates_hz.end(), minimum);
  return FrameRate{first[(rates_hz.end() - first) / 2]};
}

/// Offers every frame of every camera and lists the resulting groups.
void fill(std::span<const CameraTimes> cameras,
          FrameGrouper& grouper,
          FrameAlignment& alignment) {
  std::optional<std::int64_t> first;
  const auto drain = [&] {
    while (const auto group = grouper.next()) {
      if (!first) first = group->number;
      const auto instant = static_cast<std::size_t>(group->number - *first);
      for (AlignedCamera& camera : alignment.cameras) camera.recorded.resize(instant + 1);
      for (const GroupedFrame& frame : group->frames) {
        alignment.cameras[index(frame.camera)].recorded[instant] =
            static_cast<int>(frame.ticket);
      }
      for (const GroupedFrame& frame : group->surplus) {
        ++alignment.cameras[index(frame.camera)].surplus;
      }
    }
  };
  std::vector<std::size_t> next(cameras.size(), 0);
  for (bool more = true; more;) {
    more = false;
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      if (next[c] > cameras[c].times.size()) continue;
      more = true;
      const CameraId place{static_cast<int>(c)};
      if (next[c] == cameras[c].times.size()) {
        grouper.end(place);
        ++next[c];
        continue;
      }
      const FrameTicket ticket{static_cast<std::int64_t>(next[c])};
      if (!grouper.offer(place, cameras[c].times[next[c]], ticket).refused) ++next[c];
    }
    drain();
  }
}

Timestamp spread_of(std::span<const Timestamp> times,
                    Timestamp origin,
                    double lag_ns,
                    double period_ns) {
  std::vector<double> off;
  off.reserve(times.size());
  for (const Timestamp time : times) {
    off.push_back(std::abs(std::remainder(ns(time - origin) - lag_ns, period_ns)));
  }
  if (off.empty()) return Timestamp{0};
  const auto at = off.begin() + static_cast<std::ptrdiff_t>(off.size() * 95 / 100);
  std::nth_element(off.begin(), at, off.end());
  return Timestamp{std::llround(*at)};
}

}  // namespace

std::optional<FrameRate> measured_rate(std::span<const Timestamp> times) {
  if (times.size() < 3) return std::nullopt;
  std::vector<double> steps = steps_ns(times);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  if (!(*middle > 0.0)) return std::nullopt;
  const double guess_ns = counted_period(times, *middle);
  if (!(guess_ns > 0.0)) return std::nullopt;
  const double period_ns = slope_ns(times, best_period(times, guess_ns));
  if (!(period_ns > 0.0)) return std::nullopt;
  return FrameRate{1e9 / period_ns};
}

bool reach_too_far(std::span<const CameraTimes> cameras, FrameRate rate) {
  constexpr double kMaxPerFrame = 10.0;
  constexpr double kMaxBeyond = 10000.0;
  std::optional<Timestamp> first;
  std::optional<Timestamp> last;
  double frames = 0.0;
  for (const CameraTimes& camera : cameras) {
    if (camera.times.empty()) continue;
    first = std::min(first.value_or(camera.times.front()), camera.times.front());
    last = std::max(last.value_or(camera.times.back()), camera.times.back());
    frames += static_cast<double>(camera.times.size());
  }
  if (!first) return false;
  return seconds(*last - *first) * rate.hz > kMaxPerFrame * frames + kMaxBeyond;
}

std::optional<FrameAlignment> align_frames(std::span<const CameraTimes> cameras,
                                           std::optional<FrameRate> rate) {
  MAREY_ASSERT(!cameras.empty());
  if (!rate) rate = fastest(cameras);
  if (!rate || reach_too_far(cameras, *rate)) return std::nullopt;
  const double period_ns = 1e9 / rate->hz;
  const auto with_frames = std::find_if(
      cameras.begin(), cameras.end(), [](const auto& c) { return !c.times.empty(); });
  if (with_frames == cameras.end()) return std::nullopt;
  Timestamp origin = with_frames->times.front();
  origin += Timestamp{std::llround(mean_lag_ns(with_frames->times, origin, period_ns))};

  FrameAlignment alignment;
  alignment.rate = *rate;
  std::vector<ClockModel> clocks;
  for (const CameraTimes& camera : cameras) {
    const double lag_ns = mean_lag_ns(camera.times, origin, period_ns);
    AlignedCamera aligned;
    aligned.camera = camera.camera;
    aligned.offset = Timestamp{std::llround(lag_ns)};
    aligned.spread = spread_of(camera.times, origin, lag_ns, period_ns);
    clocks.push_back({-aligned.offset, 0.0});
    alignment.cameras.push_back(std::move(aligned));
  }
  GroupFramesOptions options;
  options.rate = *rate;
  options.origin = origin;
  FrameGrouper grouper(clocks, options);
  fill(cameras, grouper, alignment);
  return alignment;
}

}  // namespace marey::capture
