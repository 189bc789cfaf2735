// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/adaptation/members/member_scene.h"

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include "core/human/average_proportions.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"
#include "retarget/character/make_character.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey {
namespace {

constexpr std::uint64_t kSeed = 22;
constexpr double kFade_s = 0.12;

template <class T>
T made(Result<T> result) {
  if (result) return *std::move(result);
  std::fprintf(stderr, "%s\n", result.error().message().c_str());
  std::exit(2);
}

// Arms hang, elbows and knees are bent.
Pose relaxed(const Character& character) {
  Pose pose = rest_pose(character.skeleton);
  const auto turn = [&](HumanBone bone, double angle_rad, const glm::dvec3& axis) {
    pose.parent_from_joint[index(*character.skeleton.find(bone))] =
        glm::angleAxis(angle_rad, axis);
  };
  const glm::dvec3 x(1, 0, 0);
  const glm::dvec3 y(0, 1, 0);
  const glm::dvec3 z(0, 0, 1);
  turn(HumanBone::kLeftUpperArm, -1.2, z);
  turn(HumanBone::kRightUpperArm, 1.2, z);
  turn(HumanBone::kLeftLowerArm, -0.5, y);
  turn(HumanBone::kRightLowerArm, 0.5, y);
  turn(HumanBone::kLeftUpperLeg, -0.25, x);
  turn(HumanBone::kRightUpperLeg, -0.25, x);
  turn(HumanBone::kLeftLowerLeg, 0.5, x);
  turn(HumanBone::kRightLowerLeg, 0.5, x);
  return pose;
}

Constraint constraint(const char* id, const char* segment, const Goal& goal) {
  Constraint out;
  out.id = id;
  out.point.segment = segment;
  out.goal = goal;
  return out;
}

SceneMember member_of(MemberTask task,
                      std::size_t number,
                      double stature_m,
                      testing::Dice& dice) {
  SceneMember out;
  Skeleton skeleton = make_humanoid(average_proportions(stature_m));
  const auto map = made(retarget::map_body(skeleton));
  out.character = made(retarget::make_character(
      "member " + std::to_string(number), std::move(skeleton), map));
  out.reference = relaxed(out.character);
  const auto world_from_joint = world_from_joints(out.character.skeleton, out.reference);
  const auto place = [&](HumanBone bone) {
    return world_from_joint[index(*out.character.skeleton.find(bone))].translation;
  };
  std::vector<Constraint>& all = out.constraints.constraints;
  for (const auto& [segment, bone] : {std::pair("leftFoot", HumanBone::kLeftFoot),
                                      std::pair("rightFoot", HumanBone::kRightFoot)}) {
    const Support support{place(bone) + 0.02 * dice.direction(), std::nullopt, false};
    all.push_back(constraint(segment, segment, support));
  }
  if (task == MemberTask::kAllFade || (task == MemberTask::kFading && number % 5 == 4)) {
    all[1].activation = {std::nullopt, 0.0, 0.0, kFade_s};
  }
  if (task != MemberTask::kTargets) return out;
  const double far_m = number % 5 == 4 ? 0.45 * stature_m : 0.08 * stature_m;
  for (const auto& [segment, bone] : {std::pair("leftHand", HumanBone::kLeftHand),
                                      std::pair("rightHand", HumanBone::kRightHand)}) {
    const glm::dvec3 ahead = glm::dvec3(0, 0.3, 0.8) + 0.3 * dice.direction();
    all.push_back(
        constraint(segment, segment, DistanceToPoint{0.0, place(bone) + far_m * ahead}));
  }
  return out;
}

}  // namespace

std::vector<SceneMember> make_scene(MemberTask task, std::size_t count, bool alike) {
  testing::Dice dice(kSeed);
  std::vector<SceneMember> out;
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(member_of(task, i, alike ? 1.75 : dice.between(1.2, 2.1), dice));
  }
  return out;
}

retarget::Adapter make_member(const SceneMember& member,
                              const retarget::AdaptOptions& options) {
  return made(retarget::Adapter::make(member.character, member.constraints, options));
}

retarget::Crowd make_members(const std::vector<SceneMember>& scene,
                             const retarget::AdaptOptions& options,
                             const retarget::CrowdOptions& how) {
  std::vector<retarget::Adapter> members;
  for (const SceneMember& member : scene) members.push_back(make_member(member, options));
  return made(retarget::Crowd::make(std::move(members), how));
}

}  // namespace marey
