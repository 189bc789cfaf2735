// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts one posture of an adult on a child: the posture without the size of the body.
//
//     retarget_pose
#include <cmath>
#include <cstdio>
#include <vector>

#include <glm/geometric.hpp>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/skeleton.h"
#include "retarget/body/body_map.h"
#include "retarget/body/normalized_skeleton.h"

using namespace marey;

namespace {

int fail(const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.message().c_str());
  return 1;
}

/// Returns the unit vector from the joint of one bone to that of another.
glm::dvec3 direction(const Skeleton& body,
                     const std::vector<RigidTransform>& world_from_joint,
                     HumanBone from,
                     HumanBone to) {
  return glm::normalize(world_from_joint[index(*body.find(to))].translation -
                        world_from_joint[index(*body.find(from))].translation);
}

}  // namespace

int main() {
  const Skeleton adult = make_humanoid(average_proportions(1.80));
  const Skeleton child = make_humanoid(average_proportions(1.10));
  const auto adult_map = retarget::map_body(adult);
  if (!adult_map) return fail(adult_map.error());
  const auto child_map = retarget::map_body(child);
  if (!child_map) return fail(child_map.error());

  // The left arm is raised by 40 degrees, its elbow bent by 70.
  Pose posture = rest_pose(adult);
  const auto turn = [&](HumanBone bone, const glm::dvec3& axis, double degrees) {
    auto& rotation = posture.parent_from_joint[index(*adult.find(bone))];
    rotation = glm::angleAxis(degrees * std::acos(-1.0) / 180.0, axis) * rotation;
  };
  turn(HumanBone::kLeftUpperArm, {0.0, 0.0, 1.0}, 40.0);
  turn(HumanBone::kLeftLowerArm, {0.0, -1.0, 0.0}, 70.0);

  const auto normalized = retarget::normalize(adult, *adult_map, posture);
  const Pose retargeted = retarget::expand(normalized, child, *child_map);

  const auto before = world_from_joints(adult, posture);
  const auto after = world_from_joints(child, retargeted);
  const glm::dvec3 wrist = after[index(*child.find(HumanBone::kLeftHand))].translation;
  std::printf(
      "wrist_x_m %.4f\nwrist_y_m %.4f\nwrist_z_m %.4f\n", wrist.x, wrist.y, wrist.z);
  std::printf("hips_height_m %.4f\n", retargeted.root_in_world.y);
  for (const auto& [from, to] :
       {std::pair(HumanBone::kLeftUpperArm, HumanBone::kLeftLowerArm),
        std::pair(HumanBone::kLeftLowerArm, HumanBone::kLeftHand)}) {
    const glm::dvec3 turned =
        glm::cross(direction(adult, before, from, to), direction(child, after, from, to));
    std::printf("turned_deg %.6f\n",
                std::asin(glm::length(turned)) * 180.0 / std::acos(-1.0));
  }
  return 0;
}
