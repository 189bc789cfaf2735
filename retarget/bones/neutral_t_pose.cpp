// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/neutral_t_pose.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "core/pose.h"
#include "core/transform.h"
#include "retarget/bones/body_places.h"
#include "retarget/bones/neutral_bones.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

// From average_proportions(): ankle to toe joint is 0.056 leg lengths down, 0.16 forward.
constexpr double kAverageFootPitch = 19.3 * std::numbers::pi / 180.0;
constexpr double kBallHeightPerLeg = 0.024;
constexpr double kAnkleHeightPerLeg = 0.08;

void lean(const NamedNeutral& known,
          const Skeleton& skeleton,
          std::vector<glm::dquat>& t_pose) {
  for (const NeutralLean& lean : known.leans) {
    const auto joint = skeleton.find(lean.joint);
    if (!joint) continue;
    glm::dquat& turn = t_pose[index(*joint)];
    turn = glm::normalize(glm::angleAxis(lean.forward_rad, glm::dvec3(1, 0, 0)) * turn);
  }
}

/// Returns the height of the root when the feet are on the floor.
double root_height(const FoundBones& found,
                   std::span<const RigidTransform> world,
                   const glm::dvec3& up,
                   double ball_height_in_legs) {
  const auto place = [&](B bone) { return world[index(*found.joint(bone))].translation; };
  double lowest =
      std::min(glm::dot(place(B::kLeftFoot), up), glm::dot(place(B::kRightFoot), up));
  double height = kAnkleHeightPerLeg;
  for (const B toes : {B::kLeftToes, B::kRightToes}) {
    if (!found.joint(toes)) continue;
    height = ball_height_in_legs;
    lowest = std::min(lowest, glm::dot(place(toes), up));
  }
  const double leg = glm::distance(place(B::kLeftUpperLeg), place(B::kLeftLowerLeg)) +
                     glm::distance(place(B::kLeftLowerLeg), place(B::kLeftFoot));
  const double root = glm::dot(world[0].translation, up);
  return root - lowest + height * leg;
}

}  // namespace

void set_rest_t_pose(Motion& motion,
                     const FoundBones& found,
                     const glm::dvec3& up,
                     const NamedNeutral* known) {
  Skeleton& skeleton = motion.skeleton;
  const NeutralEvidence evidence = evidence_of(motion, found);
  const double pitch = known != nullptr ? known->foot_pitch_rad : kAverageFootPitch;
  std::vector<glm::dquat> rest = t_pose_of_bones(skeleton, found, evidence, pitch);
  if (known != nullptr) lean(*known, skeleton, rest);
  // In most files the body faces +Z, or -Y where Z is up.
  glm::dvec3 front = up.z > 0.0 ? glm::dvec3(0, -1, 0) : glm::dvec3(0, 1, 0);
  if (std::abs(up.z) < 0.5) front = {0, 0, 1};
  front = unit_of(front - up * glm::dot(front, up));
  const glm::dquat file_from_marey =
      glm::normalize(glm::quat_cast(glm::dmat3(glm::cross(up, front), up, front)));
  for (glm::dquat& turn : rest) {
    turn = glm::normalize(file_from_marey * turn);
    if (turn.w < 0.0) turn = -turn;
  }
  const Pose pose = pose_from_world(skeleton, glm::dvec3(0.0), rest);
  const auto world = world_from_joints(skeleton, pose);
  const double ball = known != nullptr ? known->ball_height_in_legs : kBallHeightPerLeg;
  const glm::dvec3 hips = world[index(*found.joint(B::kHips))].translation;
  const double height = root_height(found, world, up, ball);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    skeleton.joints[i].parent_from_joint.rotation = pose.parent_from_joint[i];
  }
  // Above the world's origin, independent of the file's first bone.
  skeleton.joints[0].parent_from_joint.translation =
      height * up - (hips - up * glm::dot(hips, up));
}

}  // namespace marey::retarget
