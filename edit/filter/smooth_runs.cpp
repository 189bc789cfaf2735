// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/filter/smooth_runs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <glm/geometric.hpp>

#include "core/signal/choose_smoothing.h"
#include "core/signal/smoothing_spline.h"

namespace marey::edit {
namespace {

using RunChannels = std::array<std::vector<double>, 3>;

RunChannels channels_of(const VectorRun& run) {
  RunChannels out;
  for (const glm::dvec3& value : run.values) {
    for (int axis = 0; axis < 3; ++axis) {
      out[static_cast<std::size_t>(axis)].push_back(value[axis]);
    }
  }
  return out;
}

/// Returns a robust estimate of the noise per axis.
double noise_of(const VectorRun& run) {
  std::vector<double> bends;
  for (std::size_t k = 1; k + 1 < run.values.size(); ++k) {
    bends.push_back(
        glm::length(run.values[k + 1] - 2.0 * run.values[k] + run.values[k - 1]));
  }
  const auto middle = bends.begin() + static_cast<std::ptrdiff_t>(bends.size() / 2);
  std::nth_element(bends.begin(), middle, bends.end());
  // The median length of three normal components, and a second difference's variance.
  constexpr double kMedianLength = 1.538;
  return *middle / (kMedianLength * std::sqrt(6.0));
}

/// Returns whether a run can be smoothed, and has something to smooth.
bool is_noisy(const VectorRun& run, double min_noise) {
  constexpr std::size_t kMinFrames = 5;
  return run.values.size() >= kMinFrames && noise_of(run) >= min_noise;
}

/// Returns the penalty that suits all runs together; nullopt: they have too few frames.
std::optional<double> shared_penalty(std::span<const VectorRun> runs,
                                     double min_noise,
                                     double hz) {
  constexpr std::size_t kMinRun = 8;
  std::vector<RunChannels> kept;
  std::size_t frames = 0;
  for (const VectorRun& run : runs) {
    if (run.values.size() < kMinRun || !is_noisy(run, min_noise)) continue;
    kept.push_back(channels_of(run));
    frames += run.values.size();
  }
  if (frames < kMinSmoothingSamples) return std::nullopt;
  SmoothingChannels channels;
  for (const RunChannels& run : kept) {
    channels.splines.emplace_back(run[0].size());
    for (const auto& channel : run) {
      constexpr double kConstant = 1e-9;
      const auto [low, high] = std::minmax_element(channel.begin(), channel.end());
      if (*high - *low <= kConstant) continue;
      channels.samples.emplace_back(channel);
      channels.spline_of.push_back(channels.splines.size() - 1);
    }
  }
  if (channels.samples.empty()) return std::nullopt;
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < channels.samples.size(); ++i) all.push_back(i);
  const std::vector<std::vector<std::size_t>> groups{all};
  const double penalty = choose_penalties(channels, groups).groups[0];
  constexpr double kMinCutoff_hz = 1.0;
  return std::min(penalty, penalty_of_half_power(kMinCutoff_hz, hz, {}));
}

}  // namespace

void smooth_runs(std::span<VectorRun> runs, double min_noise, double hz) {
  const auto penalty = shared_penalty(runs, min_noise, hz);
  if (!penalty) return;
  for (VectorRun& run : runs) {
    if (!is_noisy(run, min_noise)) continue;
    SmoothingSpline spline(run.values.size());
    spline.set_penalty(*penalty);
    RunChannels channels = channels_of(run);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      (void)spline.fit(channels[axis], channels[axis]);
      for (std::size_t k = 0; k < run.values.size(); ++k) {
        run.values[k][static_cast<int>(axis)] = channels[axis][k];
      }
    }
  }
}

VectorRun places_in_run(std::span<const glm::dvec3> places,
                        const glm::dquat& first_rotation,
                        const FrameRange& frames) {
  VectorRun out{frames, {}};
  const auto first = static_cast<std::size_t>(frames.first);
  for (auto t = first; t <= static_cast<std::size_t>(frames.last); ++t) {
    out.values.push_back(glm::conjugate(first_rotation) * (places[t] - places[first]));
  }
  return out;
}

}  // namespace marey::edit
