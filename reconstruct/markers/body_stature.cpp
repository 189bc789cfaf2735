// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/markers/body_stature.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <glm/geometric.hpp>

namespace marey::reconstruct {
namespace {

using B = HumanBone;

// Shares of stature. Sole to ankle and hip centres to hips are never measured. The
// seventh vertebra and with it the neck is higher than in average_proportions():
// cervicale is at 0.865 of stature (Gordon et al. 1989), markers near it at 0.84 to 0.88.
constexpr double kSole = 0.039;
constexpr double kLeg = 0.491;
constexpr double kHips = 0.010;
constexpr double kTrunkPerStature = 0.302;
constexpr double kHeadPerStature = 0.158;
constexpr double kArm = 0.332;
// Measured heads, neck to top.
constexpr double kHeadTop = 0.115;

// Standard deviations of subjects of known stature, in shares of stature.
constexpr double kSigmaWithHead = 0.020;
constexpr double kSigmaWithTrunk = 0.022;
constexpr double kSigmaLegs = 0.035;
constexpr double kSigmaTrunk = 0.045;
constexpr double kSigmaArms = 0.045;

double mean_length(const Proportions& p, std::initializer_list<B> bones) {
  double sum = 0.0;
  for (const B bone : bones) sum += glm::length(p[bone]);
  return sum / static_cast<double>(bones.size());
}

/// Returns true if a landmark is at the far end of its segment: knee, ankle, elbow,
/// wrist.
bool is_at_far_end(const Landmark& landmark) {
  const glm::dvec3& p = landmark.p_in_segment_per_stature;
  return std::max(std::abs(p.x), std::abs(p.y)) > 0.1;
}

MeasuredStature with_share(double stature_m, double share) {
  return {stature_m, share * stature_m};
}

}  // namespace

std::optional<MeasuredStature> stature_of_body(
    const Proportions& p, const std::array<bool, kHumanBoneCount>& is_measured) {
  const auto all = [&](std::initializer_list<B> bones) {
    for (const B bone : bones) {
      if (!is_measured[index(bone)]) return false;
    }
    return true;
  };
  const bool left_leg = all({B::kLeftLowerLeg, B::kLeftFoot});
  const bool right_leg = all({B::kRightLowerLeg, B::kRightFoot});
  const bool trunk = all({B::kUpperChest});
  const bool head = trunk && all({B::kHead});
  std::optional<double> leg_m;
  if (left_leg && right_leg) {
    leg_m =
        2.0 * mean_length(
                  p, {B::kLeftLowerLeg, B::kLeftFoot, B::kRightLowerLeg, B::kRightFoot});
  } else if (left_leg || right_leg) {
    leg_m = left_leg ? 2.0 * mean_length(p, {B::kLeftLowerLeg, B::kLeftFoot})
                     : 2.0 * mean_length(p, {B::kRightLowerLeg, B::kRightFoot});
  }
  const double trunk_m =
      4.0 * mean_length(p, {B::kSpine, B::kChest, B::kUpperChest, B::kNeck});
  if (leg_m && head) {
    const double chain_m = *leg_m + trunk_m + glm::length(p[B::kHead]);
    return with_share(chain_m / (1.0 - kSole - kHips - kHeadTop), kSigmaWithHead);
  }
  if (leg_m && trunk) {
    return with_share((*leg_m + trunk_m) / (kLeg + kTrunkPerStature), kSigmaWithTrunk);
  }
  if (leg_m) return with_share(*leg_m / kLeg, kSigmaLegs);
  if (head) {
    const double chain_m = trunk_m + glm::length(p[B::kHead]);
    return with_share(chain_m / (kTrunkPerStature + kHeadPerStature - kHeadTop),
                      kSigmaTrunk);
  }
  if (trunk) return with_share(trunk_m / kTrunkPerStature, kSigmaTrunk);
  if (all({B::kLeftLowerArm, B::kLeftHand, B::kRightLowerArm, B::kRightHand})) {
    return with_share(
        2.0 *
            mean_length(
                p, {B::kLeftLowerArm, B::kLeftHand, B::kRightLowerArm, B::kRightHand}) /
            kArm,
        kSigmaArms);
  }
  return std::nullopt;
}

std::array<bool, kHumanBoneCount> bones_between(
    std::span<const Landmark* const> landmarks) {
  std::array<bool, kHumanBoneCount> near_end{};
  std::array<bool, kHumanBoneCount> far_end{};
  for (const Landmark* landmark : landmarks) {
    if (landmark == nullptr || landmark->sigma_per_stature >= kSomewhereSigma) continue;
    auto& ends = is_at_far_end(*landmark) ? far_end : near_end;
    ends[index(landmark->segment)] = true;
  }
  const auto at = [&](B bone) { return near_end[index(bone)] || far_end[index(bone)]; };
  std::array<bool, kHumanBoneCount> measured{};
  for (const HumanLimb& limb : human_limbs()) {
    const bool is_leg = limb.end == B::kLeftFoot || limb.end == B::kRightFoot;
    const B root = is_leg ? B::kHips : *parent(limb.upper);
    const bool middle = far_end[index(limb.upper)] || near_end[index(limb.lower)];
    const bool end = far_end[index(limb.lower)] || at(limb.end);
    measured[index(limb.lower)] = at(root) && middle;
    measured[index(limb.end)] = middle && end;
  }
  const bool trunk = at(B::kHips) && at(B::kUpperChest);
  for (const B bone : {B::kSpine, B::kChest, B::kUpperChest, B::kNeck}) {
    measured[index(bone)] = trunk;
  }
  measured[index(B::kHead)] = trunk && at(B::kHead);
  return measured;
}

}  // namespace marey::reconstruct
