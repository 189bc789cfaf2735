// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/adaptation/adaptation_actor.h"

#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "core/transform.h"
#include "retarget/body/body_map.h"
#include "retarget/character/make_character.h"

namespace marey {
namespace {

using B = HumanBone;

constexpr glm::dvec3 kX{1, 0, 0};
constexpr glm::dvec3 kY{0, 1, 0};
constexpr glm::dvec3 kZ{0, 0, 1};

[[noreturn]] void stop(const Error& error) {
  std::fprintf(stderr, "%s\n", error.message().c_str());
  std::exit(1);
}

}  // namespace

Character make_actor(const recordings::MannequinOptions& body,
                     const CharacterTraits& traits) {
  Skeleton skeleton = make_humanoid(recordings::mannequin_proportions(body));
  const auto map = retarget::map_body(skeleton);
  if (!map) stop(map.error());
  auto character = retarget::make_character("actor", std::move(skeleton), *map, traits);
  if (!character) stop(character.error());
  return *std::move(character);
}

void turn(Pose& pose,
          const Character& character,
          HumanBone bone,
          double angle_deg,
          const glm::dvec3& axis) {
  const auto joint = character.skeleton.find(bone);
  glm::dquat& q = pose.parent_from_joint[index(*joint)];
  q = glm::angleAxis(angle_deg * std::numbers::pi / 180.0, axis) * q;
}

Pose standing(const Character& character, double knee_deg) {
  Pose pose = rest_pose(character.skeleton);
  const double sole_m = place_of(character, pose, B::kLeftFoot).y;
  turn(pose, character, B::kLeftLowerArm, -20, kY);
  turn(pose, character, B::kRightLowerArm, 20, kY);
  turn(pose, character, B::kLeftUpperArm, -78, kZ);
  turn(pose, character, B::kRightUpperArm, 78, kZ);
  for (const B hip : {B::kLeftUpperLeg, B::kRightUpperLeg}) {
    turn(pose, character, hip, -0.5 * knee_deg, kX);
  }
  for (const B knee : {B::kLeftLowerLeg, B::kRightLowerLeg}) {
    turn(pose, character, knee, knee_deg, kX);
  }
  for (const B foot : {B::kLeftFoot, B::kRightFoot}) {
    turn(pose, character, foot, -0.5 * knee_deg, kX);
  }
  pose.root_in_world.y += sole_m - place_of(character, pose, B::kLeftFoot).y;
  return pose;
}

glm::dvec3 place_of(const Character& character, const Pose& pose, HumanBone bone) {
  const auto joint = character.skeleton.find(bone);
  return world_from_joints(character.skeleton, pose)[index(*joint)].translation;
}

glm::dvec3 centre_of_mass(const Character& character, const Pose& pose, bool with_loads) {
  const auto world_from_joint = world_from_joints(character.skeleton, pose);
  glm::dvec3 moment(0.0);
  double mass_kg = 0.0;
  const auto add = [&](const PointMass& mass) {
    moment += mass.mass_kg * (world_from_joint[index(mass.joint)] * mass.p_in_joint);
    mass_kg += mass.mass_kg;
  };
  for (const PointMass& mass : character.masses) add(mass);
  if (with_loads) {
    for (const Load& load : character.loads) add(load.mass);
  }
  return moment / mass_kg;
}

Constraint contact(HumanBone bone, const glm::dvec3& p_in_world, double importance) {
  Constraint out;
  out.id = name(bone);
  out.point.segment = out.id;
  out.goal = DistanceToPoint{0.0, p_in_world};
  out.importance = importance;
  return out;
}

Constraint stance(HumanBone foot, const std::optional<glm::dvec3>& footprint_in_world) {
  Constraint out;
  out.id = name(foot);
  out.point.segment = out.id;
  out.goal = Support{footprint_in_world, std::nullopt, false};
  return out;
}

Adapted adapted(std::string_view who,
                const Character& character,
                const Pose& reference,
                const ConstraintSet& constraints,
                const retarget::AdaptOptions& options) {
  auto adapter = retarget::Adapter::make(character, constraints, options);
  if (!adapter) stop(adapter.error());
  for (const Load& load : character.loads) adapter->carry(load.name, true);
  Adapted out;
  out.report = adapter->adapt(reference, 0.0, out.pose);
  out.com_in_world = centre_of_mass(character, out.pose, true);
  std::printf("%-28s worst %6.1f mm, mean %6.1f mm, balance %6.1f mm, %d iterations\n",
              std::string(who).c_str(),
              1e3 * out.report.worst_error_m,
              1e3 * out.report.constraint_error_m,
              1e3 * out.report.balance_error_m,
              out.report.iterations);
  return out;
}

void show_centre_of_mass(PictureScene& scene,
                         const glm::dvec3& com_in_world,
                         Paint paint,
                         double floor_m) {
  // The wanted one is thicker below and thinner above: both are seen when they agree.
  const bool wanted = paint == Paint::kWantedCentre;
  const glm::dvec3 foot_in_world(com_in_world.x, floor_m, com_in_world.z);
  scene.add_ball(com_in_world, wanted ? 0.036 : 0.042, paint);
  scene.add_rod(foot_in_world, com_in_world, wanted ? 0.011 : 0.007, paint);
  scene.add_rod(foot_in_world,
                foot_in_world + glm::dvec3(0, 0.012, 0),
                wanted ? 0.07 : 0.04,
                paint);
}

}  // namespace marey
