// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/neutral_evidence.h"

#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "core/pose.h"
#include "core/transform.h"
#include "retarget/bones/body_places.h"

namespace marey::retarget {
namespace {

void add_limbs(const FoundBones& found,
               std::span<const RigidTransform> world,
               NeutralEvidence& evidence) {
  for (std::size_t i = 0; i < 4; ++i) {
    const HumanLimb& limb = human_limbs()[i];
    const auto upper = found.joint(limb.upper);
    const auto lower = found.joint(limb.lower);
    const auto end = found.joint(limb.end);
    if (!upper || !lower || !end) continue;
    const auto place = [&](JointIndex joint) { return world[index(joint)].translation; };
    const glm::dvec3 hinge = glm::cross(unit_of(place(*lower) - place(*upper)),
                                        unit_of(place(*end) - place(*lower)));
    evidence.hinge[i][0] += glm::conjugate(world[index(*upper)].rotation) * hinge;
    evidence.hinge[i][1] += glm::conjugate(world[index(*lower)].rotation) * hinge;
  }
}

}  // namespace

NeutralEvidence evidence_of(const Motion& motion, const FoundBones& found) {
  NeutralEvidence evidence;
  const std::size_t count = motion.skeleton.joints.size();
  evidence.joint_from_parent.assign(count, glm::dmat3(0.0));
  std::vector<RigidTransform> world(count);
  for (const Pose& pose : motion.poses) {
    world_from_joints(motion.skeleton, pose, world);
    for (std::size_t i = 0; i < count; ++i) {
      evidence.joint_from_parent[i] +=
          glm::transpose(glm::mat3_cast(pose.parent_from_joint[i]));
    }
    add_limbs(found, world, evidence);
    evidence.frames += 1.0;
  }
  return evidence;
}

}  // namespace marey::retarget
