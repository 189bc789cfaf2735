// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/retarget/plate_clock.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/human/centre_of_mass.h"
#include "core/pose.h"
#include "retarget/body/place_masses.h"

namespace marey {
namespace {

constexpr double kSmoothing_s = 0.03;
constexpr double kStep_s = 0.005;

// Gaussian mean of a uniformly sampled signal at one time; its last values count beyond
// its ends.
double smoothed(const std::vector<double>& values, double hz, double time_s) {
  const int reach = static_cast<int>(std::ceil(4.0 * kSmoothing_s * hz));
  const int middle = static_cast<int>(std::lround(time_s * hz));
  const int last = static_cast<int>(values.size()) - 1;
  double sum = 0.0;
  double weights = 0.0;
  for (int k = middle - reach; k <= middle + reach; ++k) {
    const double away = (k / hz - time_s) / kSmoothing_s;
    const double w = std::exp(-0.5 * away * away);
    sum += w * values[static_cast<std::size_t>(std::clamp(k, 0, last))];
    weights += w;
  }
  return sum / weights;
}

double acceleration(const std::vector<double>& height_m, double hz, double time_s) {
  const double h = 1.0 / hz;
  return (smoothed(height_m, hz, time_s - h) - 2.0 * smoothed(height_m, hz, time_s) +
          smoothed(height_m, hz, time_s + h)) /
         (h * h);
}

// Share of the variance of `y` that a line through `x` leaves.
double unexplained(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mx = 0.0;
  double my = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mx += x[i] / n;
    my += y[i] / n;
  }
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mx) * (x[i] - mx);
    xy += (x[i] - mx) * (y[i] - my);
    yy += (y[i] - my) * (y[i] - my);
  }
  return xx > 0.0 && yy > 0.0 ? 1.0 - xy * xy / (xx * yy) : 1.0;
}

// Longest time in which feet follow each other on the plates without a break, less the
// double supports at its ends: there the other foot may be on the floor.
LoadInterval time_on_plates(const ContactTrial& trial) {
  constexpr double kDoubleSupport_s = 0.14;
  std::vector<LoadInterval> loads;
  for (const PlateLoad& load : trial.loads) {
    loads.insert(loads.end(), load.intervals.begin(), load.intervals.end());
  }
  std::sort(loads.begin(), loads.end(), [](const auto& a, const auto& b) {
    return a.first_s < b.first_s;
  });
  LoadInterval best;
  LoadInterval chain;
  for (const LoadInterval& load : loads) {
    if (load.first_s > chain.last_s) chain = load;
    chain.last_s = std::max(chain.last_s, load.last_s);
    if (chain.last_s - chain.first_s > best.last_s - best.first_s) best = chain;
  }
  return {best.first_s + kDoubleSupport_s, best.last_s - kDoubleSupport_s};
}

}  // namespace

std::optional<PlateClock> plate_clock(const ContactTrial& trial) {
  constexpr double kMinTime_s = 0.25;
  constexpr double kMaxUnexplained = 0.1;
  constexpr int kMaxDelay_ms = 60;
  const LoadInterval time = time_on_plates(trial);
  if (time.last_s - time.first_s < kMinTime_s) return std::nullopt;
  const auto masses = retarget::place_masses(trial.motion.skeleton, trial.map, {});
  if (!masses) return std::nullopt;
  std::vector<double> height_m;
  for (const Pose& pose : trial.motion.poses) {
    height_m.push_back(
        centre_of_mass(*masses, world_from_joints(trial.motion.skeleton, pose)).y);
  }
  std::vector<double> force;
  std::vector<double> times_s;
  for (double t = time.first_s; t <= time.last_s; t += kStep_s) {
    double total_N = 0.0;
    for (const PlateLoad& load : trial.loads) {
      const auto& at_s = load.time_s;
      if (at_s.size() < 2) continue;
      const double hz =
          static_cast<double>(at_s.size() - 1) / (at_s.back() - at_s.front());
      total_N += smoothed(load.force_N, hz, t - at_s.front());
    }
    times_s.push_back(t);
    force.push_back(total_N);
  }
  PlateClock best{0.0, 1.0};
  for (int delay_ms = -kMaxDelay_ms; delay_ms <= kMaxDelay_ms; ++delay_ms) {
    std::vector<double> model;
    for (const double t : times_s) {
      model.push_back(acceleration(height_m, trial.motion.rate.hz, t - 1e-3 * delay_ms));
    }
    const double left = unexplained(model, force);
    if (left < best.unexplained_share) best = {1e-3 * delay_ms, left};
  }
  const bool is_inside = std::abs(best.delay_s) < 1e-3 * (kMaxDelay_ms - 0.5);
  if (!is_inside || best.unexplained_share > kMaxUnexplained) return std::nullopt;
  return best;
}

}  // namespace marey
