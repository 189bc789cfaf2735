// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/clips/rig.h"

#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "core/base/assert.h"
#include "core/transform.h"
#include "retarget/body/body_volume.h"

namespace marey::engine {
namespace {

// Places of kPostureSegments that are used here.
constexpr std::size_t kHipsAt = kSegmentRotation;
constexpr std::size_t kHeadAt = kSegmentRotation + 2;
constexpr std::size_t kLeftShoulderAt = kSegmentRotation + 3;
constexpr std::size_t kLeftFootAt = kSegmentRotation + 7;
constexpr std::size_t kMiddleTorso = kTorsoRotation + kTorsoKnots / 2;

glm::dquat rotation_of(const BlendPosture& posture, std::size_t i) {
  return {static_cast<double>(posture.w[i]),
          static_cast<double>(posture.x[i]),
          static_cast<double>(posture.y[i]),
          static_cast<double>(posture.z[i])};
}

glm::dvec3 limb_end(const BlendPosture& posture, std::size_t limb, double length) {
  return length * std::cos(static_cast<double>(posture.fold_rad[limb])) *
         (rotation_of(posture, kLimbRotation + limb) * glm::dvec3(0, 0, 1));
}

}  // namespace

Rig make_rig(const Skeleton& skeleton, const retarget::BodyMap& map) {
  const std::vector<RigidTransform> t_pose = retarget::t_pose_joints(skeleton, map);
  const auto place = [&](JointIndex joint) { return t_pose[index(joint)].translation; };
  const glm::dvec3 hips = place(map.hips());
  const double unit = 1.0 / map.leg_length_m;
  Rig rig;
  rig.leg_length_m = map.leg_length_m;
  const auto of_bone = [&](HumanBone bone) { return map.joint_of[index(bone)]; };
  glm::dvec3 neck = hips;
  if (map.limbs[0] && map.limbs[1]) {
    neck = 0.5 * (place(map.limbs[0]->upper) + place(map.limbs[1]->upper));
  }
  if (const auto joint = of_bone(HumanBone::kNeck)) neck = place(*joint);
  rig.neck_from_hips_legs = unit * (neck - hips);
  if (const auto joint = of_bone(HumanBone::kHead)) {
    rig.head_from_neck_legs = unit * (place(*joint) - neck);
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const retarget::LimbMap& leg = map.leg(static_cast<int>(side));
    rig.hip_from_hips_legs[side] = unit * (place(leg.upper) - hips);
    rig.leg_legs[side] = unit * leg.length_m();
    const retarget::FootMap& foot = map.feet[side];
    rig.ball_from_ankle_legs[side] = unit * foot.ball_from_ankle_in_t_pose;
    rig.ankle_height_legs[side] = unit * foot.ankle_height_m;
    rig.ball_height_legs[side] = unit * foot.ball_height_m;
    if (!map.limbs[side]) continue;
    rig.shoulder_from_neck_legs[side] = unit * (place(map.limbs[side]->upper) - neck);
    rig.arm_legs[side] = unit * map.limbs[side]->length_m();
  }
  return rig;
}

FootPlaces foot_places(const Rig& rig, const BlendPosture& posture) {
  const glm::dquat hips = rotation_of(posture, kHipsAt);
  FootPlaces out;
  for (std::size_t side = 0; side < 2; ++side) {
    out.ankle[side] = hips * rig.hip_from_hips_legs[side] +
                      limb_end(posture, 2 + side, rig.leg_legs[side]);
    out.ball[side] = out.ankle[side] + rotation_of(posture, kLeftFootAt + side) *
                                           rig.ball_from_ankle_legs[side];
  }
  return out;
}

UpperPlaces upper_places(const Rig& rig, const BlendPosture& posture) {
  const glm::dquat trunk = rotation_of(posture, kMiddleTorso);
  const glm::dvec3 neck = trunk * rig.neck_from_hips_legs;
  UpperPlaces out;
  out.head = neck + rotation_of(posture, kHeadAt) * rig.head_from_neck_legs;
  for (std::size_t side = 0; side < 2; ++side) {
    out.wrist[side] =
        neck +
        rotation_of(posture, kLeftShoulderAt + side) * rig.shoulder_from_neck_legs[side] +
        limb_end(posture, side, rig.arm_legs[side]);
  }
  return out;
}

}  // namespace marey::engine
