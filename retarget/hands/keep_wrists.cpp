// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/hands/keep_wrists.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "retarget/body/arm_shift.h"
#include "retarget/body/place_spine.h"

namespace marey::retarget {
namespace {

constexpr double kSameShare = 1e-6;
constexpr double kNothing = 1e-9;  // [m]

bool alike(const SpineSection& a, const SpineSection& b) {
  if (a.count != b.count) return false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.count); ++i) {
    if (std::abs(a.at[i] - b.at[i]) > kSameShare) return false;
  }
  return true;
}

}  // namespace

bool spines_differ(const BodyMap& source, const BodyMap& avatar) {
  if (!source.spine || !avatar.spine) return false;
  const SpineShares& a = source.spine->shares;
  const SpineShares& b = avatar.spine->shares;
  return std::abs(a.abdomen - b.abdomen) > kSameShare ||
         std::abs(a.torso - b.torso) > kSameShare ||
         !alike(source.abdomen, avatar.abdomen) || !alike(source.torso, avatar.torso);
}

bool keep_wrists(const Skeleton& body,
                 const BodyMap& map,
                 std::span<const RigidTransform> world_from_joint,
                 NormalizedPose& pose) {
  const auto missing_m = shoulders_missing_m(pose, body, map, world_from_joint);
  bool changed = false;
  for (std::size_t side = 0; side < 2; ++side) {
    if (!map.limbs[side] || !pose.limbs[side]) continue;
    if (glm::length(missing_m[side]) < kNothing) continue;
    const double length_m = map.limbs[side]->length_m();
    NormalizedLimb& arm = *pose.limbs[side];
    const glm::dvec3 wanted = arm.end_from_root() * length_m + missing_m[side];
    changed = aim_arm(wanted, length_m, 0.0, arm) || changed;
  }
  return changed;
}

}  // namespace marey::retarget
