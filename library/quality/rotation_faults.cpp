// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/rotation_faults.h"

#include <algorithm>
#include <cmath>

#include "core/base/degrees.h"

namespace marey::library {
namespace {

constexpr double kFrozen_rad = 1e-6;
constexpr double kMoving_rad_s = 1.0 * kRadiansPerDegree;
constexpr int kOthers = 3;
constexpr double kFlip_rad_s = 1500.0 * kRadiansPerDegree;
constexpr double kFlip_rad = 40.0 * kRadiansPerDegree;
constexpr double kFlipBack = 0.4;

bool is_animated(const BonePath& bone) {
  const auto resting =
      std::count_if(bone.step_rad.begin() + 1, bone.step_rad.end(), [](double step_rad) {
        return step_rad < kFrozen_rad;
      });
  return 2 * resting < static_cast<std::ptrdiff_t>(bone.step_rad.size());
}

FoundFigure find_frozen(const QualityFrames& frames, double warn_s) {
  FoundFigure out{"frozen_s"};
  if (frames.count < 3) return out;
  std::vector<int> moving(static_cast<std::size_t>(frames.count), 0);
  for (const BonePath& bone : frames.bones) {
    for (std::size_t t = 0; t < bone.step_rad.size(); ++t) {
      if (bone.step_rad[t] * frames.hz > kMoving_rad_s) ++moving[t];
    }
  }
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    const BonePath& bone = frames.bones[b];
    const auto whole = static_cast<HumanBone>(b);
    // Solvers keep the toes of a standing foot flat.
    const bool is_toes = whole == HumanBone::kLeftToes || whole == HumanBone::kRightToes;
    if (bone.empty() || is_toes || !is_animated(bone)) continue;
    int first = 1;
    for (int t = 1; t <= frames.count; ++t) {
      const auto i = static_cast<std::size_t>(t);
      if (t < frames.count && bone.step_rad[i] < kFrozen_rad && moving[i] >= kOthers) {
        continue;
      }
      // The rotation is the same from frame `first` - 1 to t - 1.
      const double run_s = (t - first) / frames.hz;
      if (run_s > out.value) {
        out.value = run_s;
        out.bone = whole;
        out.frames = FrameRange{first - 1, t - 1};
      }
      if (run_s > warn_s) out.places.push_back({{first - 1, t - 1}, whole, run_s});
      first = t + 1;
    }
  }
  return out;
}

double angle_rad(const glm::dquat& a, const glm::dquat& b) {
  return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b))));
}

FoundFigure find_flips(const QualityFrames& frames, const Motion& motion) {
  FoundFigure out{"flip_count"};
  const double limit_rad = std::max(kFlip_rad, kFlip_rad_s / frames.hz);
  const int back = std::max(5, static_cast<int>(std::lround(0.2 * frames.hz)));
  double largest_rad = 0.0;
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    const BonePath& bone = frames.bones[b];
    const std::size_t j = index(bone.joint);
    for (int t = 1; t < frames.count && !bone.empty(); ++t) {
      const double turn_rad = bone.step_rad[static_cast<std::size_t>(t)];
      if (turn_rad < limit_rad) continue;
      const auto& before =
          motion.poses[static_cast<std::size_t>(t) - 1].parent_from_joint[j];
      for (int u = t + 1; u < std::min(frames.count, t + back + 1); ++u) {
        const auto i = static_cast<std::size_t>(u);
        if (bone.step_rad[i] < limit_rad ||
            angle_rad(before, motion.poses[i].parent_from_joint[j]) >
                kFlipBack * turn_rad) {
          continue;
        }
        out.value += 1.0;
        out.places.push_back(
            {{t, u - 1}, static_cast<HumanBone>(b), turn_rad * kDegreesPerRadian});
        if (turn_rad > largest_rad) {
          largest_rad = turn_rad;
          out.bone = static_cast<HumanBone>(b);
          out.frames = FrameRange{t, u - 1};
        }
        t = u;
        break;
      }
    }
  }
  return out;
}

}  // namespace

std::array<FoundFigure, 2> find_rotation_faults(const QualityFrames& frames,
                                                const Motion& motion,
                                                const QualityLimits& limits) {
  return {find_frozen(frames, limits["frozen_s"].warn), find_flips(frames, motion)};
}

}  // namespace marey::library
