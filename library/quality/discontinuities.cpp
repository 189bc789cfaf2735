// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/discontinuities.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>

#include <glm/geometric.hpp>

namespace marey::library {
namespace {

constexpr int kAround = 8;
constexpr int kSpikeReach = 4;  ///< A displaced position changes this many differences.
constexpr double kSpikeScale_m = 0.016;
constexpr double kMinSpikeScale_m = 0.004;
constexpr double kSpikeAround = 0.5;
constexpr double kMaxSpikeAround = 1.5;
constexpr double kSpikeRate_hz = 30.0;
constexpr int kCutReach = 2;
constexpr double kCutScale_m = 0.0006;
constexpr double kCutQuantile = 0.93;
constexpr int kCutJoints = 3;
// The steps next to a cut have two thirds of its irregularity, those of a spike all of
// it.
constexpr double kRegular = 0.8;
// Noise is in all joints, fast motion in the limbs.
constexpr double kQuietJoints = 0.25;
constexpr double kWorldJitter = 1.0 / 3.0;
constexpr int kMinFrames = 12;
// Median length of a vector of three standard normal numbers, and the standard deviation
// of the eighth difference of standard normal numbers, sqrt(16 over 8).
constexpr double kMedianOfNoise = 1.5382;
constexpr double kEighthOfNoise = 113.446;

// Quantile of the values on either side of t, without the `reach` next to it. `first` and
// `last` limit the valid values.
double quantile_around(
    std::span<const double> values, int t, int reach, int first, int last, double share) {
  std::array<double, 2 * kAround> window{};
  std::size_t count = 0;
  for (int side = -1; side <= 1; side += 2) {
    for (int k = reach + 1; k <= reach + kAround; ++k) {
      const int u = t + side * k;
      if (u >= first && u <= last) window[count++] = values[static_cast<std::size_t>(u)];
    }
  }
  return quantile_in_place(std::span(window).first(count), share);
}

glm::dvec3 eighth_difference(std::span<const glm::dvec3> x, std::size_t t) {
  return 70.0 * x[t] - 56.0 * (x[t - 1] + x[t + 1]) + 28.0 * (x[t - 2] + x[t + 2]) -
         8.0 * (x[t - 3] + x[t + 3]) + (x[t - 4] + x[t + 4]);
}

// Lengths of the eighth differences. [m]
void measure_eighth(std::span<const glm::dvec3> x, std::span<double> e_m) {
  for (std::size_t t = 4; t + 4 < x.size(); ++t) {
    e_m[t] = glm::length(eighth_difference(x, t));
  }
}

/// Denominator of a spike's score: scale + around * the median around it.
struct SpikeScale {
  double scale_m = kSpikeScale_m;
  double around = kSpikeAround;
};

SpikeScale spike_scale(double hz) {
  // At higher rates smooth motion has smaller differences, but noise has the same.
  const double ratio = std::max(1.0, hz / kSpikeRate_hz);
  return {std::max(kMinSpikeScale_m, kSpikeScale_m / ratio),
          std::min(kMaxSpikeAround, kSpikeAround * ratio)};
}

void find_spikes(std::span<const double> eighth_m,
                 HumanBone bone,
                 const SpikeScale& scale,
                 double warn,
                 FoundFigure& out) {
  const int last = static_cast<int>(eighth_m.size()) - 1 - kSpikeReach;
  for (int t = kSpikeReach; t <= last; ++t) {
    const double e_m = eighth_m[static_cast<std::size_t>(t)] / 70.0;
    // The score is at most this: most frames need no median.
    if (e_m / scale.scale_m <= std::min(out.value, warn)) continue;
    const double around_m =
        quantile_around(eighth_m, t, kSpikeReach, kSpikeReach, last, 0.5) / 70.0;
    const double score = e_m / (scale.scale_m + scale.around * around_m);
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
  return quantile_in_place(medians, 0.2) / (kMedianOfNoise * kEighthOfNoise);
}

std::optional<HumanBone> present_above(const QualityFrames& frames, HumanBone bone) {
  auto up = parent(bone);
  while (up && frames[*up].empty()) up = parent(*up);
  return up;
}

/// Irregular steps of all main joints.
struct Steps {
  std::vector<std::vector<double>> q_m;  ///< [joint][frame]
  int last = 0;
};

Steps irregular_steps(const QualityFrames& frames) {
  Steps out;
  out.last = frames.count - 2 - kCutReach;
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    if (frames.bones[b].empty()) continue;
    const auto& x = frames.bones[b].p_in_world;
    std::vector<double> q_m(x.size(), 0.0);
    for (std::size_t t = 2; t + 3 < x.size(); ++t) {
      q_m[t] = glm::length(10.0 * (x[t + 1] - x[t]) - 5.0 * (x[t + 2] - x[t - 1]) +
                           (x[t + 3] - x[t - 2])) /
               6.0;
    }
    out.q_m.push_back(std::move(q_m));
  }
  return out;
}

// Score of a cut after frame t: that of the joint with the third largest one.
double score_of_cut(const Steps& steps, int t, double needed) {
  std::array<double, kHumanBoneCount> scores{};
  const auto i = static_cast<std::size_t>(t);
  const auto is_large = [&](double q_m) { return q_m > needed * kCutScale_m; };
  // A joint's score is at most q / scale: most frames need no quantiles.
  if (std::count_if(steps.q_m.begin(), steps.q_m.end(), [&](const auto& q_m) {
        return is_large(q_m[i]);
      }) < kCutJoints) {
    return 0.0;
  }
  std::size_t count = 0;
  for (const auto& q_m : steps.q_m) {
    if (!is_large(q_m[i])) continue;
    if (std::max(q_m[i - 1], q_m[i + 1]) > kRegular * q_m[i]) continue;
    scores[count++] =
        q_m[i] /
        (kCutScale_m +
         3.0 * quantile_around(q_m, t, kCutReach, kCutReach, steps.last, kCutQuantile));
  }
  if (count < kCutJoints) return 0.0;
  std::nth_element(scores.begin(),
                   scores.begin() + kCutJoints - 1,
                   scores.begin() + static_cast<std::ptrdiff_t>(count),
                   std::greater<>());
  return scores[kCutJoints - 1];
}

FoundFigure find_cuts(const QualityFrames& frames, double warn) {
  FoundFigure out{"cut"};
  const Steps steps = irregular_steps(frames);
  for (int t = kCutReach; t <= steps.last; ++t) {
    const double score = score_of_cut(steps, t, std::min(out.value, warn));
    if (score > out.value) {
      out.value = score;
      out.frames = FrameRange{t, t + 1};
    }
    if (score > warn) add_place(out.places, {{t, t + 1}, std::nullopt, score}, 0);
  }
  return out;
}

// Ends of a bone in the frame of the bone above its joint: p_c - p_b, turned.
void in_frame_above(const QualityFrames& frames,
                    const BonePath& above,
                    const BonePath& joint,
                    const BonePath& end,
                    std::span<glm::dvec3> out) {
  for (std::size_t t = 0; t < static_cast<std::size_t>(frames.count); ++t) {
    out[t] = glm::conjugate(above.world_from_t_pose[t]) *
             (end.p_in_world[t] - joint.p_in_world[t]);
  }
}

FoundFigure summarize_jitter(std::span<double> local_m,
                             std::span<double> world_m,
                             int count,
                             double warn) {
  FoundFigure out{"jitter_mm"};
  out.value = 1000.0 * std::max(quantile_in_place(local_m, kQuietJoints),
                                kWorldJitter * quantile_in_place(world_m, kQuietJoints));
  if (out.value > warn) {
    out.frames = FrameRange{0, count - 1};
    out.places.push_back({*out.frames, std::nullopt, out.value});
  }
  return out;
}

}  // namespace

std::array<FoundFigure, 3> find_discontinuities(const QualityFrames& frames,
                                                const QualityLimits& limits) {
  FoundFigure spike{"spike"};
  if (frames.count < kMinFrames) {
    return {spike, FoundFigure{"jitter_mm"}, FoundFigure{"cut"}};
  }
  const SpikeScale scale = spike_scale(frames.hz);
  const int window = std::max(4, static_cast<int>(std::lround(0.4 * frames.hz)));
  std::vector<double> e_m(static_cast<std::size_t>(frames.count), 0.0);
  std::vector<glm::dvec3> local(e_m.size());
  std::vector<double> medians;
  medians.reserve(e_m.size() / static_cast<std::size_t>(window) + 1);
  std::array<double, kHumanBoneCount> world_m{};
  std::array<double, kHumanBoneCount> local_m{};
  std::size_t worlds = 0;
  std::size_t locals = 0;
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    const auto bone = static_cast<HumanBone>(b);
    if (frames.bones[b].empty()) continue;
    measure_eighth(frames.bones[b].p_in_world, e_m);
    find_spikes(e_m, bone, scale, limits["spike"].warn, spike);
    world_m[worlds++] = quiet_jitter_m(e_m, window, medians);
    const auto joint = present_above(frames, bone);
    const auto above = joint ? present_above(frames, *joint) : std::nullopt;
    if (!above) continue;
    in_frame_above(frames, frames[*above], frames[*joint], frames.bones[b], local);
    measure_eighth(local, e_m);
    local_m[locals++] = quiet_jitter_m(e_m, window, medians);
  }
  return {std::move(spike),
          summarize_jitter(std::span(local_m).first(locals),
                           std::span(world_m).first(worlds),
                           frames.count,
                           limits["jitter_mm"].warn),
          find_cuts(frames, limits["cut"].warn)};
}

}  // namespace marey::library
