// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/neutral_pose.h"

#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/pose.h"
#include "core/transform.h"
#include "retarget/bones/body_places.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

BodyPlaces places_in(const FoundBones& found, std::span<const RigidTransform> world) {
  return body_places(found,
                     [&](JointIndex joint) { return world[index(joint)].translation; });
}

/// Returns the turn about `up` that makes a body face the direction that most files use.
glm::dquat facing(const BodyPlaces& p, const glm::dvec3& up) {
  const glm::dvec3 usual = up.z > 0.5 ? glm::dvec3(0, -1, 0) : glm::dvec3(0, 0, 1);
  const glm::dvec3 left = p.hip[0] - p.hip[1];
  const glm::dvec3 front = glm::cross(unit_of(left - up * glm::dot(left, up)), up);
  const bool is_level = std::abs(glm::dot(usual, up)) < 0.5;
  if (!is_level || front == glm::dvec3(0.0)) return {1.0, 0.0, 0.0, 0.0};
  return rotation_between(front, usual);
}

}  // namespace

void rest_as_pose(Motion& motion,
                  const FoundBones& found,
                  const glm::dvec3& up,
                  const Pose& pose) {
  Skeleton& skeleton = motion.skeleton;
  const BodyPlaces p = places_in(found, world_from_joints(skeleton, pose));
  const glm::dquat turn = facing(p, up);
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    skeleton.joints[i].parent_from_joint.rotation = pose.parent_from_joint[i];
  }
  RigidTransform& root = skeleton.joints[0].parent_from_joint;
  root.rotation = glm::normalize(turn * root.rotation);
  const glm::dvec3 level = p.hips - up * glm::dot(p.hips, up);
  root.translation = turn * (pose.root_in_world - level);
}

Status rest_as_other(const Skeleton& other,
                     const FoundBones& found,
                     const glm::dvec3& up,
                     Motion& motion) {
  constexpr double kAlike = 0.94;  // Cosine of 20 degrees.
  Skeleton& skeleton = motion.skeleton;
  for (const B bone : human_bones()) {
    const auto joint = found.joint(bone);
    if (!joint) continue;
    const Joint& own = skeleton[*joint];
    const auto there = other.find(own.name);
    if (!there) {
      return bad_input("",
                       "it has no joint '" + own.name + "', which is the motion's " +
                           std::string(name(bone)),
                       "use a file of the same skeleton");
    }
    const glm::dvec3 a = unit_of(own.parent_from_joint.translation);
    const glm::dvec3 b = unit_of(other[*there].parent_from_joint.translation);
    const bool is_free = bone == B::kHips || a == glm::dvec3(0) || b == glm::dvec3(0);
    if (is_free || glm::dot(a, b) > kAlike) continue;
    return bad_input("",
                     "the bone that ends at '" + own.name +
                         "' has another direction in its joint's axes than the motion's",
                     "use a file of the same skeleton, from the same program");
  }
  for (Joint& joint : skeleton.joints) {
    const auto there = other.find(joint.name);
    if (there)
      joint.parent_from_joint.rotation = other[*there].parent_from_joint.rotation;
  }
  rest_as_pose(motion, found, up, rest_pose(skeleton));
  return Done{};
}

}  // namespace marey::retarget
