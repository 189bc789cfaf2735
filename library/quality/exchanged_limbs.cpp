// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/quality/exchanged_limbs.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace marey::library {
namespace {

using B = HumanBone;

constexpr double kExchanged = 0.5;
constexpr double kOff_m = 0.04;
constexpr double kPair_s = 2.0;

struct PairOfLimbs {
  HumanBone left{};                  ///< For reports.
  std::array<HumanBone, 2> roots{};  ///< Left, right.
  std::array<std::array<HumanBone, 2>, 3> joints{};
};

constexpr std::array<PairOfLimbs, 2> kPairs{{
    {B::kLeftLowerArm,
     {B::kLeftUpperArm, B::kRightUpperArm},
     {{{B::kLeftLowerArm, B::kRightLowerArm},
       {B::kLeftHand, B::kRightHand},
       {B::kLeftHand, B::kRightHand}}}},
    {B::kLeftLowerLeg,
     {B::kLeftUpperLeg, B::kRightUpperLeg},
     {{{B::kLeftLowerLeg, B::kRightLowerLeg},
       {B::kLeftFoot, B::kRightFoot},
       {B::kLeftToes, B::kRightToes}}}},
}};

// True if the limbs are exchanged between t - 1 and t.
bool is_exchange(const QualityFrames& frames,
                 const PairOfLimbs& pair,
                 std::size_t t,
                 bool relative) {
  double own_m = 0.0;
  double other_m = 0.0;
  int count = 0;
  for (const auto& joints : pair.joints) {
    std::array<glm::dvec3, 2> now{};
    std::array<glm::dvec3, 2> continued{};
    bool whole = true;
    for (std::size_t s = 0; s < 2; ++s) {
      const BonePath& path = frames[joints[s]];
      const BonePath& root = frames[pair.roots[s]];
      if (path.empty() || root.empty()) {
        whole = false;
        break;
      }
      const auto at = [&](std::size_t u) {
        return relative ? path.p_in_world[u] - root.p_in_world[u] : path.p_in_world[u];
      };
      now[s] = at(t);
      continued[s] = 2.0 * at(t - 1) - at(t - 2);
    }
    if (!whole) continue;
    own_m += glm::distance(now[0], continued[0]) + glm::distance(now[1], continued[1]);
    other_m += glm::distance(now[0], continued[1]) + glm::distance(now[1], continued[0]);
    count += 2;
  }
  return count > 0 && own_m > kOff_m * count && other_m < kExchanged * own_m;
}

void find_swaps(const QualityFrames& frames, const PairOfLimbs& pair, FoundFigure& out) {
  int begin = -1;  // None. (An optional makes GCC 12 warn of an uninitialized value.)
  const auto add = [&](int first, int last) {
    out.places.push_back({{first, last}, pair.left, 1.0 + last - first});
    out.value += 1.0 + last - first;
    if (!out.frames) {
      out.frames = FrameRange{first, last};
      out.bone = pair.left;
    }
  };
  for (int t = 2; t < frames.count; ++t) {
    if (begin >= 0 && t - begin > kPair_s * frames.hz) {
      add(begin, begin);
      begin = -1;
    }
    const auto i = static_cast<std::size_t>(t);
    if (!is_exchange(frames, pair, i, false) && !is_exchange(frames, pair, i, true)) {
      continue;
    }
    if (begin >= 0) {
      add(begin, t - 1);
      begin = -1;
    } else {
      begin = t;
    }
    // The velocity across an exchange continues nothing.
    ++t;
  }
  if (begin >= 0) add(begin, begin);
}

FoundFigure find_backward_toes(const QualityFrames& frames, double warn) {
  FoundFigure out{"sides_share"};
  const BonePath& left = frames[B::kLeftUpperLeg];
  const BonePath& right = frames[B::kRightUpperLeg];
  const BonePath& hips = frames[B::kHips];
  const BonePath& spine = frames[B::kNeck].empty() ? frames[B::kHead] : frames[B::kNeck];
  if (hips.empty() || left.empty() || right.empty()) return out;
  int backwards = 0;
  for (std::size_t t = 0; t < hips.p_in_world.size(); ++t) {
    const glm::dvec3 across = left.p_in_world[t] - right.p_in_world[t];
    // Up along the trunk, so that lying bodies count, too.
    const glm::dvec3 up = spine.empty() ? glm::dvec3(0.0, 1.0, 0.0)
                                        : spine.p_in_world[t] - hips.p_in_world[t];
    const glm::dvec3 front = glm::cross(across, up);
    double sum = 0.0;
    for (std::size_t s = 0; s < 2; ++s) {
      sum += glm::dot(front,
                      frames.ball_in_world[s][t] -
                          frames[foot_of(static_cast<int>(s))].p_in_world[t]);
    }
    if (sum < 0.0) ++backwards;
  }
  if (frames.count > 0) out.value = static_cast<double>(backwards) / frames.count;
  if (out.value > warn) {
    out.frames = FrameRange{0, frames.count - 1};
    out.places.push_back({*out.frames, std::nullopt, out.value});
  }
  return out;
}

}  // namespace

std::array<FoundFigure, 2> find_exchanged_limbs(const QualityFrames& frames,
                                                const QualityLimits& limits) {
  FoundFigure swaps{"swap_frames"};
  for (const PairOfLimbs& pair : kPairs) find_swaps(frames, pair, swaps);
  return {std::move(swaps), find_backward_toes(frames, limits["sides_share"].warn)};
}

}  // namespace marey::library
