// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/discontinuities.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>

namespace marey::library {
namespace {

constexpr int kAround = 8;
constexpr double kSpikeScale_m = 0.008;
constexpr double kCutScale_m = 0.001;
constexpr double kCutShare = 0.75;
// The steps next to a cut have two thirds of its irregularity, those of a spike all of
// it.
constexpr double kRegular = 0.8;
// Noise is in all joints, fast motion in the limbs.
constexpr double kQuietJoints = 0.25;
constexpr int kMinFrames = 12;
// Median length of a vector of three standard normal numbers, and the standard deviation
// of the eighth difference of standard normal numbers, sqrt(16 over 8).
constexpr double kMedianOfNoise = 1.5382;
constexpr double kEighthOfNoise = 113.446;

double median_around(std::span<const double> values, int t, int first, int last) {
  std::array<double, 2 * kAround + 1> window{};
  std::size_t count = 0;
  for (int u = std::max(first, t - kAround); u <= std::min(last, t + kAround); ++u) {
    window[count++] = values[static_cast<std::size_t>(u)];
  }
  return quantile_in_place(std::span(window).first(count), 0.5);
}

void measure_spikes(std::span<const glm::dvec3> x, std::span<double> e_m) {
  for (std::size_t t = 3; t + 3 < x.size(); ++t) {
    e_m[t] = glm::length(x[t] - 0.75 * (x[t - 1] + x[t + 1]) +
                         0.3 * (x[t - 2] + x[t + 2]) - 0.05 * (x[t - 3] + x[t + 3]));
  }
}

void measure_noise(std::span<const glm::dvec3> x, std::span<double> e_m) {
  for (std::size_t t = 4; t + 4 < x.size(); ++t) {
    const glm::dvec3 eighth = 70.0 * x[t] - 56.0 * (x[t - 1] + x[t + 1]) +
                              28.0 * (x[t - 2] + x[t + 2]) - 8.0 * (x[t - 3] + x[t + 3]) +
                              (x[t - 4] + x[t + 4]);
    e_m[t] = glm::length(eighth) / (kMedianOfNoise * kEighthOfNoise);
  }
}

void find_spikes(std::span<const double> e_m,
                 HumanBone bone,
                 double warn,
                 FoundFigure& out) {
  const int last = static_cast<int>(e_m.size()) - 4;
  for (int t = 3; t <= last; ++t) {
    // The score is at most this: most frames need no median.
    const double at_most = e_m[static_cast<std::size_t>(t)] / kSpikeScale_m;
    if (at_most <= std::min(out.value, warn)) continue;
    const double score = e_m[static_cast<std::size_t>(t)] /
                         (kSpikeScale_m + 2.0 * median_around(e_m, t, 3, last));
    if (score > out.value) {
      out.value = score;
      out.bone = bone;
      out.frames = FrameRange{t, t};
    }
    if (score > warn) add_place(out.places, {{t, t}, bone, score}, 1);
  }
}

double quiet_jitter_m(std::span<double> e_m, int window, std::vector<double>& medians) {
  medians.clear();
  const auto count = static_cast<int>(e_m.size()) - 8;
  for (int first = 0; first < count; first += window) {
    const int size = std::min(window, count - first);
    // The last window may be too short for a median.
    if (first > 0 && size < window / 2) break;
    medians.push_back(quantile_in_place(
        e_m.subspan(static_cast<std::size_t>(first) + 4, static_cast<std::size_t>(size)),
        0.5));
  }
  return quantile_in_place(medians, 0.2);
}

// The step from t to t + 1 of most of the joints, as far as the steps before and after do
// not continue.
std::vector<double> irregular_steps_m(const QualityFrames& frames) {
  std::vector<double> q_m(static_cast<std::size_t>(frames.count), 0.0);
  std::array<double, kHumanBoneCount> d_m{};
  for (std::size_t t = 2; t + 3 < q_m.size(); ++t) {
    std::size_t count = 0;
    for (const BonePath& bone : frames.bones) {
      if (bone.empty()) continue;
      const auto& x = bone.p_in_world;
      d_m[count++] = glm::length(10.0 * (x[t + 1] - x[t]) - 5.0 * (x[t + 2] - x[t - 1]) +
                                 (x[t + 3] - x[t - 2])) /
                     6.0;
    }
    q_m[t] = quantile_in_place(std::span(d_m).first(count), kCutShare);
  }
  return q_m;
}

FoundFigure find_cuts(const QualityFrames& frames, double warn) {
  FoundFigure out{"cut"};
  const std::vector<double> q_m = irregular_steps_m(frames);
  const int last = frames.count - 4;
  for (int t = 2; t <= last; ++t) {
    const auto i = static_cast<std::size_t>(t);
    if (q_m[i] / kCutScale_m <= std::min(out.value, warn)) continue;
    if (std::max(q_m[i - 1], q_m[i + 1]) > kRegular * q_m[i]) continue;
    const double score = q_m[i] / (kCutScale_m + 3.0 * median_around(q_m, t, 2, last));
    if (score > out.value) {
      out.value = score;
      out.frames = FrameRange{t, t + 1};
    }
    if (score > warn) add_place(out.places, {{t, t + 1}, std::nullopt, score}, 0);
  }
  return out;
}

}  // namespace

std::array<FoundFigure, 3> find_discontinuities(const QualityFrames& frames,
                                                const QualityLimits& limits) {
  FoundFigure spike{"spike"};
  FoundFigure jitter{"jitter_mm"};
  if (frames.count < kMinFrames) return {spike, jitter, FoundFigure{"cut"}};
  const double warn = limits["spike"].warn;
  const int window = std::max(4, static_cast<int>(std::lround(0.4 * frames.hz)));
  std::vector<double> e_m(static_cast<std::size_t>(frames.count), 0.0);
  std::vector<double> medians;
  medians.reserve(e_m.size() / static_cast<std::size_t>(window) + 1);
  std::array<double, kHumanBoneCount> jitter_m{};
  std::size_t bones = 0;
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    if (frames.bones[b].empty()) continue;
    measure_spikes(frames.bones[b].p_in_world, e_m);
    find_spikes(e_m, static_cast<HumanBone>(b), warn, spike);
    measure_noise(frames.bones[b].p_in_world, e_m);
    jitter_m[bones++] = quiet_jitter_m(e_m, window, medians);
  }
  jitter.value =
      1000.0 * quantile_in_place(std::span(jitter_m).first(bones), kQuietJoints);
  if (jitter.value > limits["jitter_mm"].warn) {
    jitter.frames = FrameRange{0, frames.count - 1};
    jitter.places.push_back({*jitter.frames, std::nullopt, jitter.value});
  }
  return {std::move(spike), std::move(jitter), find_cuts(frames, limits["cut"].warn)};
}

}  // namespace marey::library
