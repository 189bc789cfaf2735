// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/activity.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>

#include <glm/geometric.hpp>

#include "core/base/degrees.h"

namespace marey::library {
namespace {

using B = HumanBone;

constexpr double kWindow_s = 4.0;
constexpr double kMaxFrequency_hz = 10.0;
constexpr double kStep_hz = 0.25;
constexpr int kFrequencies = 41;
constexpr double kMinAmplitude = 0.05;
constexpr double kStill_m_s = 0.05;

// Amplitude spectrum over its first value at 0, 0.25... 10 Hz. False without movement.
bool find_spectrum(std::span<const double> speed,
                   double hz,
                   std::array<double, kFrequencies>& amplitude) {
  for (int k = 0; k < kFrequencies; ++k) {
    const double turn_rad = 2.0 * std::numbers::pi * k * kStep_hz / hz;
    const std::complex<double> step(std::cos(turn_rad), -std::sin(turn_rad));
    std::complex<double> phase = 1.0;
    std::complex<double> sum = 0.0;
    for (const double v : speed) {
      sum += v * phase;
      phase *= step;
    }
    amplitude[static_cast<std::size_t>(k)] = std::abs(sum);
  }
  const double first = amplitude[0];
  if (first <= kStill_m_s * static_cast<double>(speed.size())) return false;
  for (double& a : amplitude) a /= first;
  return true;
}

double arc_length(std::span<const double> amplitude, double hz) {
  const double highest_hz = std::min(kMaxFrequency_hz, 0.5 * hz);
  auto last = std::min(static_cast<std::size_t>(kFrequencies - 1),
                       static_cast<std::size_t>(highest_hz / kStep_hz));
  while (last > 1 && amplitude[last] < kMinAmplitude) --last;
  double length = 0.0;
  for (std::size_t k = 1; k <= last; ++k) {
    length +=
        std::hypot(1.0 / static_cast<double>(last), amplitude[k] - amplitude[k - 1]);
  }
  return -length;
}

double mean_sparc(const QualityFrames& frames) {
  const auto window =
      std::max<std::size_t>(2, static_cast<std::size_t>(kWindow_s * frames.hz));
  std::vector<double> speed;
  speed.reserve(static_cast<std::size_t>(frames.count));
  std::array<double, kFrequencies> amplitude{};
  double sum = 0.0;
  int count = 0;
  for (const B bone : {B::kHips, B::kLeftHand, B::kRightHand}) {
    const auto& p = frames[bone].p_in_world;
    speed.clear();
    for (std::size_t t = 1; t < p.size(); ++t) {
      speed.push_back(glm::distance(p[t], p[t - 1]) * frames.hz);
    }
    for (std::size_t first = 0; first < speed.size(); first += window) {
      const std::size_t size = std::min(window, speed.size() - first);
      if (first > 0 && 2 * size < window) break;
      if (!find_spectrum(std::span(speed).subspan(first, size), frames.hz, amplitude)) {
        continue;
      }
      sum += arc_length(amplitude, frames.hz);
      ++count;
    }
  }
  return count > 0 ? sum / count : 0.0;
}

double still_share(const QualityFrames& frames) {
  if (frames.count < 2) return 1.0;
  int still = 0;
  const double limit_m = kStill_m_s / frames.hz;
  for (std::size_t t = 1; t < static_cast<std::size_t>(frames.count); ++t) {
    const bool moves =
        std::any_of(frames.bones.begin(), frames.bones.end(), [&](const auto& bone) {
          return !bone.empty() &&
                 glm::distance(bone.p_in_world[t], bone.p_in_world[t - 1]) > limit_m;
        });
    if (!moves) ++still;
  }
  return static_cast<double>(still) / (frames.count - 1);
}

double mean_speed_m_s(const QualityFrames& frames) {
  const auto& hips = frames[B::kHips].p_in_world;
  double way_m = 0.0;
  for (std::size_t t = 1; t < hips.size(); ++t) {
    way_m += std::hypot(hips[t].x - hips[t - 1].x, hips[t].z - hips[t - 1].z);
  }
  return frames.count > 1 ? way_m * frames.hz / (frames.count - 1) : 0.0;
}

double t_pose_share(const QualityFrames& frames, const retarget::BodyMap& map) {
  const std::vector<char> in_t_pose = t_pose_frames(frames, map);
  const auto count = std::count(in_t_pose.begin(), in_t_pose.end(), 1);
  return frames.count > 0 ? static_cast<double>(count) / frames.count : 0.0;
}

}  // namespace

std::vector<char> t_pose_frames(const QualityFrames& frames,
                                const retarget::BodyMap& map) {
  const double min_cosine = std::cos(15.0 * kRadiansPerDegree);
  const auto& hips = frames[B::kHips].world_from_t_pose;
  std::vector<char> out(hips.size(), 0);
  for (std::size_t t = 0; t < hips.size(); ++t) {
    bool all = true;
    for (std::size_t l = 0; l < 4 && all; ++l) {
      if (!map.limbs[l]) continue;
      const glm::dvec3& along = map.limbs[l]->along_in_t_pose;
      for (const B bone : {human_limbs()[l].upper, human_limbs()[l].lower}) {
        const glm::dquat turn =
            glm::conjugate(hips[t]) * frames[bone].world_from_t_pose[t];
        all = all && glm::dot(turn * along, along) > min_cosine;
      }
    }
    out[t] = all ? 1 : 0;
  }
  return out;
}

std::array<FoundFigure, 5> measure_activity(const QualityFrames& frames,
                                            const retarget::BodyMap& map) {
  std::array<FoundFigure, 5> out{FoundFigure{"sparc"},
                                 FoundFigure{"still_share"},
                                 FoundFigure{"tpose_share"},
                                 FoundFigure{"seconds"},
                                 FoundFigure{"speed_m_s"}};
  out[0].value = mean_sparc(frames);
  out[1].value = still_share(frames);
  out[2].value = t_pose_share(frames, map);
  out[3].value = std::max(0, frames.count - 1) / frames.hz;
  out[4].value = mean_speed_m_s(frames);
  return out;
}

}  // namespace marey::library
