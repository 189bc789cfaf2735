// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/arm_shift.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/base/assert.h"
#include "core/transform.h"

namespace marey::retarget {
namespace {

// An arm follows exactly up to this share of its length, or up to its current extension.
// Beyond, it follows ever more slowly, since the last percent of extension takes ten
// degrees of the elbow at once.
constexpr double kExact = 0.97;
constexpr double kMaxReachRatio = 0.9995;
constexpr double kNoShift = 1e-9;  // [m], [rad]

bool is_zero(const ArmShift& shift) {
  return glm::length(shift.wrist_m) < kNoShift && std::abs(shift.swivel_rad) < kNoShift;
}

// Returns the extension of an arm for a wanted one, in its lengths. Continuous slope.
double reached(double wanted, double extension_before) {
  const double exact = std::max(kExact, extension_before);
  const double left = kMaxReachRatio - exact;
  if (wanted <= exact) return wanted;
  if (left <= 0.0) return exact;
  return exact + left * (1.0 - std::exp((exact - wanted) / left));
}

}  // namespace

bool aim_arm(const glm::dvec3& wrist_from_shoulder_m,
             double length_m,
             double swivel_rad,
             NormalizedLimb& arm) {
  const double distance_m = glm::length(wrist_from_shoulder_m);
  if (distance_m < 1e-9) return false;
  const glm::dvec3 axis = wrist_from_shoulder_m / distance_m;
  const glm::dvec3 before = arm.world_from_limb * glm::dvec3(0, 0, 1);
  arm.world_from_limb =
      glm::normalize(glm::angleAxis(swivel_rad, axis) * rotation_between(before, axis) *
                     arm.world_from_limb);
  arm.extension = reached(distance_m / length_m, arm.extension);
  return true;
}

ArmShift limited_shift(const ArmShift& shift, double arm_length_m) {
  const auto share = [](double size, double max_size) {
    const double twice = (size / max_size) * (size / max_size);
    const double eightfold = twice * twice * twice * twice;
    return std::pow(1.0 + eightfold, -0.125);
  };
  return {share(glm::length(shift.wrist_m), kMaxWayOut * arm_length_m) * shift.wrist_m,
          share(shift.swivel_rad, kMaxSwivel_rad) * shift.swivel_rad};
}

NormalizedLimb shifted_limb(const LimbMap& arm,
                            const ArmPlaces& now,
                            const NormalizedLimb& limb,
                            const ArmShift& shift) {
  NormalizedLimb out = limb;
  const glm::dvec3 wanted = now.wrist + shift.wrist_m - now.shoulder;
  aim_arm(wanted, arm.length_m(), shift.swivel_rad, out);
  return out;
}

ArmPlaces shifted_places(const LimbMap& arm,
                         const ArmPlaces& now,
                         const NormalizedLimb& limb,
                         const ArmShift& shift) {
  ArmPlaces out = now;
  if (is_zero(shift)) return out;
  const NormalizedLimb bent = shifted_limb(arm, now, limb, shift);
  const double l1 = arm.upper_length_m;
  const double l2 = arm.lower_length_m;
  const double distance = std::clamp(
      bent.extension * arm.length_m(), std::max(std::abs(l1 - l2), 1e-9), l1 + l2);
  const double along =
      std::clamp(0.5 * (distance + (l1 - l2) * (l1 + l2) / distance), -l1, l1);
  const double offset = std::sqrt(std::max(l1 * l1 - along * along, 0.0));
  out.elbow = out.shoulder + bent.world_from_limb * glm::dvec3(offset, 0.0, along);
  out.wrist = out.shoulder + bent.world_from_limb * glm::dvec3(0.0, 0.0, distance);
  return out;
}

ArmPlaces arm_places(const LimbMap& arm, std::span<const RigidTransform> joints) {
  return {joints[index(arm.upper)].translation,
          joints[index(arm.lower)].translation,
          joints[index(arm.end)].translation};
}

Arms::Arms(const PosedFrames& frames, const BodyMap& map) : frames_(&frames), map_(&map) {
  NormalizedPose pose;
  for (std::size_t t = 0; t < frames.count(); ++t) {
    normalize(map, frames[t], pose, RootNormalization::kNone);
    for (std::size_t side = 0; side < 2; ++side) {
      if (pose.limbs[side]) limbs_[side].push_back(*pose.limbs[side]);
    }
  }
}

ArmPlaces Arms::places(std::size_t t, int side) const {
  return arm_places(limb(side), (*frames_)[t]);
}

NormalizedLimb Arms::shifted_limb(std::size_t t, int side, const ArmShift& shift) const {
  return retarget::shifted_limb(
      limb(side), places(t, side), limbs_[static_cast<std::size_t>(side)][t], shift);
}

ArmPlaces Arms::places(std::size_t t, int side, const ArmShift& shift) const {
  return shifted_places(
      limb(side), places(t, side), limbs_[static_cast<std::size_t>(side)][t], shift);
}

double Arms::out_of_reach_m(std::size_t t, int side, const ArmShift& shift) const {
  const glm::dvec3 wanted = places(t, side).wrist + shift.wrist_m;
  return glm::distance(places(t, side, shift).wrist, wanted);
}

void shift_arms(const Arms& arms,
                const BodyMap& map,
                const PosedFrames& frames,
                const ArmShifts& shifts,
                Motion& motion) {
  MAREY_ASSERT(arms.count() == motion.poses.size());
  const Skeleton& skeleton = motion.skeleton;
  std::vector<RigidTransform> world_from_joint(skeleton.joints.size());
  NormalizedPose pose;
  Pose expanded;
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    std::array<bool, 2> moved{};
    for (int side = 0; side < 2; ++side) {
      const auto s = static_cast<std::size_t>(side);
      moved[s] = arms.has(side) && !is_zero(shifts[s][t]);
    }
    if (!moved[0] && !moved[1]) continue;
    normalize(map, frames[t], pose, RootNormalization::kNone);
    for (int side = 0; side < 2; ++side) {
      const auto s = static_cast<std::size_t>(side);
      if (moved[s]) pose.limbs[s] = arms.shifted_limb(t, side, shifts[s][t]);
    }
    expand(pose, skeleton, map, world_from_joint, expanded);
    for (int side = 0; side < 2; ++side) {
      if (!moved[static_cast<std::size_t>(side)]) continue;
      const LimbMap& arm = arms.limb(side);
      for (const JointIndex joint : {arm.upper, arm.lower, arm.end}) {
        motion.poses[t].parent_from_joint[index(joint)] =
            expanded.parent_from_joint[index(joint)];
      }
    }
  }
}

}  // namespace marey::retarget
