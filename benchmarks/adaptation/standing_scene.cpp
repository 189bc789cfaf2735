// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/adaptation/standing_scene.h"

#include <cstdio>
#include <cstdlib>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "benchmarks/adaptation/posture_measures.h"
#include "core/base/degrees.h"
#include "core/human/average_proportions.h"
#include "core/humanoid.h"
#include "core/skeleton.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"
#include "retarget/character/make_character.h"

namespace marey {
namespace {

/// Arms hanging, elbows and knees not quite straight, the ankles where the T-pose has
/// their height.
Pose standing(const Skeleton& skeleton) {
  Pose pose = rest_pose(skeleton);
  const auto turn = [&](HumanBone bone, const glm::dvec3& axis, double angle_deg) {
    auto& rotation = pose.parent_from_joint[index(*skeleton.find(bone))];
    rotation = glm::angleAxis(angle_deg * kRadiansPerDegree, axis) * rotation;
  };
  for (const HumanLimb& limb : human_limbs()) {
    if (limb.end == HumanBone::kLeftHand || limb.end == HumanBone::kRightHand) {
      const double side = limb.end == HumanBone::kLeftHand ? -1.0 : 1.0;
      turn(limb.upper, {0.0, 0.0, 1.0}, side * 78.0);
      turn(limb.lower, limb.hinge_axis, 20.0);
    } else {
      turn(limb.upper, limb.hinge_axis, -6.0);
      turn(limb.lower, limb.hinge_axis, 12.0);
      turn(limb.end, limb.hinge_axis, -6.0);
    }
  }
  const std::size_t ankle = index(*skeleton.find(HumanBone::kLeftFoot));
  pose.root_in_world.y +=
      world_from_joints(skeleton, rest_pose(skeleton))[ankle].translation.y -
      world_from_joints(skeleton, pose)[ankle].translation.y;
  return pose;
}

}  // namespace

StandingScene standing_scene() {
  Skeleton skeleton = make_humanoid(average_proportions(1.75));
  const auto map = retarget::map_body(skeleton);
  auto character = map ? retarget::make_character("standing", skeleton, *map)
                       : Result<Character>(map.error());
  if (!character) {
    std::fprintf(stderr, "%s\n", character.error().message().c_str());
    std::exit(2);
  }
  StandingScene scene;
  scene.character = *std::move(character);
  scene.reference = standing(skeleton);
  scene.goals = {{*skeleton.find(HumanBone::kRightHand), false},
                 {*skeleton.find(HumanBone::kLeftHand), false},
                 {*skeleton.find(HumanBone::kRightFoot), false},
                 {*skeleton.find(HumanBone::kLeftFoot), true}};
  scene.com_in_world = centre_of_mass(scene.character, scene.reference);
  const auto world_from_joint = world_from_joints(skeleton, scene.reference);
  StandingScene::Targets start{};
  for (std::size_t k = 0; k < start.size(); ++k) {
    start[k] = world_from_joint[index(scene.goals[k].joint)].translation;
  }
  scene.near = start;
  scene.near[0] += glm::dvec3(-0.05, 0.25, 0.30);
  scene.near[1] += glm::dvec3(0.05, 0.30, 0.25);
  scene.near[2] += glm::dvec3(-0.05, 0.12, 0.15);
  scene.far = start;
  scene.far[0] = {-0.25, 0.85, 0.70};
  scene.far[1] = {0.30, 1.10, 0.70};
  scene.far[2] = {-0.30, 0.35, -0.30};
  scene.unreachable = start;
  scene.unreachable[0] = {-1.20, 1.60, 1.20};
  scene.unreachable[1] = {1.30, 1.20, 1.10};
  scene.unreachable[2] = {-0.50, 0.60, -1.40};
  return scene;
}

}  // namespace marey
