// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/retarget/hand_scenes.h"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/base/smooth_step.h"
#include "retarget/body/normalized_skeleton.h"
#include "tests/retarget/mapped.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

using B = HumanBone;
using P = VolumePart;

constexpr double kGap_m = 0.003;
constexpr double kHalfPi = 1.57079632679489661923;

glm::dquat about(const glm::dvec3& axis, double angle_rad) {
  return glm::angleAxis(angle_rad, axis);
}

// Arms hang slightly forward and outward, clear of the thighs.
HandPlace hanging(const BodyMap& map, std::span<const RigidTransform> rest, int side) {
  const double out = side == 0 ? 1.0 : -1.0;
  const LimbMap& arm = *map.limbs[static_cast<std::size_t>(side)];
  const glm::dvec3 shoulder = rest[index(arm.upper)].translation;
  return {
      shoulder + 1.1 * arm.length_m() * glm::normalize(glm::dvec3(0.28 * out, -1, 0.2)),
      about({0, 0, 1}, -out * kHalfPi)};
}

// Computes the wrist that brings the hand there, with the elbow down, back and out.
void put_hand(const Skeleton& body,
              const BodyMap& map,
              const BodyVolume& volume,
              const HandPlace& place,
              int side,
              NormalizedPose& pose) {
  const auto i = static_cast<std::size_t>(side);
  const LimbMap& arm = *map.limbs[i];
  const Capsule& hand = *volume[on_side(P::kLeftHand, side)];
  pose.segments[index(side == 0 ? B::kLeftHand : B::kRightHand)] =
      place.world_from_t_pose;
  const glm::dvec3 wrist =
      place.middle_in_world - place.world_from_t_pose * axis_point_in_joint(hand, 0.0);
  const auto joints = world_from_joints(body, expand(pose, body, map));
  const glm::dvec3 reach = wrist - joints[index(arm.upper)].translation;
  const glm::dvec3 z = glm::normalize(reach);
  const glm::dvec3 hint = glm::normalize(glm::dvec3(side == 0 ? 0.6 : -0.6, -0.7, -0.6));
  const glm::dvec3 x = glm::normalize(hint - z * glm::dot(hint, z));
  NormalizedLimb& limb = *pose.limbs[i];
  limb.world_from_limb = glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z));
  limb.extension = std::min(glm::length(reach) / arm.length_m(), 0.98);
  limb.mid_offset = {0.2, 0.0};
}

struct Stand {
  Skeleton body = adult();
  BodyMap map = mapped(body);
  BodyVolume volume = average_volume(body, map);
  std::vector<RigidTransform> joints = world_from_joints(body, rest_pose(body));

  [[nodiscard]] glm::dvec3 on(P part, const glm::dvec3& way) const {
    const Capsule& capsule = *volume[part];
    const RigidTransform world =
        joints[index(capsule.joint)] * capsule.joint_from_capsule;
    const double side = way.x > 0.5 ? 1.0 : way.x < -0.5 ? -1.0 : 0.0;
    const bool across = part == P::kPelvis || part == P::kAbdomen;
    const double along = across ? side : way.y;
    return world * glm::dvec3(0, 0, along * capsule.half_length_m) +
           way * (capsule.radius_m + kGap_m + volume[P::kLeftHand]->radius_m);
  }
};

}  // namespace

Skeleton adult() {
  return make_humanoid(average_proportions(1.75));
}

Motion hands_go_to(const HandPlaces& places, double noise_rad, double noise_m) {
  const Stand stand;
  Motion motion{stand.body, FrameRate{60.0}, 0, {}};
  const NormalizedPose standing = normalize(stand.body, stand.map, rest_pose(stand.body));
  testing::Dice dice(11);
  for (int t = 0; t < kSceneFrames; ++t) {
    const double there =
        smooth_step((t - 60) / 30.0) * (1.0 - smooth_step((t - kHeldLast) / 30.0));
    NormalizedPose pose = standing;
    for (int side = 0; side < 2; ++side) {
      const HandPlace from = hanging(stand.map, stand.joints, side);
      const auto& place = places[static_cast<std::size_t>(side)];
      HandPlace to = place.value_or(from);
      const double aside = place ? there * (1.0 - there) : 0.0;
      to.middle_in_world = glm::mix(from.middle_in_world, to.middle_in_world, there);
      // Around the body, not through it.
      to.middle_in_world.z += 0.8 * aside;
      to.middle_in_world.x += (side == 0 ? 0.6 : -0.6) * aside;
      to.world_from_t_pose =
          glm::slerp(from.world_from_t_pose, to.world_from_t_pose, there);
      put_hand(stand.body, stand.map, stand.volume, to, side, pose);
    }
    motion.poses.push_back(expand(pose, stand.body, stand.map));
    Pose& out = motion.poses.back();
    for (glm::dquat& q : out.parent_from_joint) {
      const glm::dvec3 turn(
          dice.noise(noise_rad), dice.noise(noise_rad), dice.noise(noise_rad));
      q = glm::normalize(q * rotation_from_vector(turn));
    }
    out.root_in_world +=
        glm::dvec3(dice.noise(noise_m), dice.noise(noise_m), dice.noise(noise_m));
  }
  return motion;
}

HandPlaces clapping() {
  const Stand stand;
  const double apart = stand.volume[P::kLeftHand]->radius_m + 0.5 * kGap_m;
  const glm::dvec3 middle(0.0, 1.25, 0.40);
  return {HandPlace{middle + glm::dvec3(apart, 0, 0), about({0, 1, 0}, -kHalfPi)},
          HandPlace{middle - glm::dvec3(apart, 0, 0), about({0, 1, 0}, kHalfPi)}};
}

HandPlaces hand_on_head() {
  return {HandPlace{Stand().on(P::kHead, {0, 1, 0}), about({0, 0, 1}, 2.0 * kHalfPi)},
          std::nullopt};
}

HandPlaces hands_on_hips() {
  const Stand stand;
  return {HandPlace{stand.on(P::kPelvis, {1, 0, 0}), about({0, 0, 1}, -kHalfPi)},
          HandPlace{stand.on(P::kPelvis, {-1, 0, 0}), about({0, 0, 1}, kHalfPi)}};
}

HandPlaces hand_on_belly() {
  return {HandPlace{Stand().on(P::kAbdomen, {0, 0, 1}), about({0, 0, 1}, 2.0 * kHalfPi)},
          std::nullopt};
}

Skeleton broad(double factor) {
  Proportions p = average_proportions(1.75);
  for (const B bone : {B::kLeftUpperArm,
                       B::kRightUpperArm,
                       B::kLeftShoulder,
                       B::kRightShoulder,
                       B::kLeftUpperLeg,
                       B::kRightUpperLeg}) {
    p[bone].x *= factor;
  }
  return make_humanoid(p);
}

Skeleton ape() {
  Proportions p = average_proportions(1.75);
  for (const HumanBone bone : {HumanBone::kLeftLowerLeg,
                               HumanBone::kLeftFoot,
                               HumanBone::kRightLowerLeg,
                               HumanBone::kRightFoot}) {
    p[bone] *= 0.5;
  }
  p[HumanBone::kHips].y *= 0.5;
  for (const HumanBone bone : {HumanBone::kLeftLowerArm,
                               HumanBone::kLeftHand,
                               HumanBone::kRightLowerArm,
                               HumanBone::kRightHand}) {
    p[bone] *= 1.75;
  }
  return make_humanoid(p);
}

double deepest_hand_m(const Motion& motion) {
  const BodyMap map = mapped(motion.skeleton);
  const BodyVolume volume = average_volume(motion.skeleton, map);
  double deepest = 0.0;
  for (const Pose& pose : motion.poses) {
    const auto world = world_from_joints(motion.skeleton, pose);
    for (int side = 0; side < 2; ++side) {
      const JointIndex hand = volume[on_side(VolumePart::kLeftHand, side)]->joint;
      deepest = std::max(deepest, -lowest_m(volume, side, world[index(hand)]));
    }
  }
  return deepest;
}

BodyVolume with_belly(BodyVolume volume, double factor) {
  for (const P part : {P::kAbdomen, P::kPelvis}) {
    volume[part]->half_length_m *= factor;
    volume[part]->radius_m *= factor;
  }
  return volume;
}

double gap_m(const BodyVolume& volume,
             std::span<const RigidTransform> joints,
             VolumePart a,
             VolumePart b) {
  const auto point = [&](P part, int i) {
    const Capsule& capsule = *volume[part];
    return joints[index(capsule.joint)] * axis_point_in_joint(capsule, 0.02 * i - 1.0);
  };
  double minimum = std::numeric_limits<double>::max();
  for (int i = 0; i <= 100; ++i) {
    for (int k = 0; k <= 100; ++k) {
      minimum = std::min(minimum, glm::distance(point(a, i), point(b, k)));
    }
  }
  return minimum - volume[a]->radius_m - volume[b]->radius_m;
}

}  // namespace marey::retarget
