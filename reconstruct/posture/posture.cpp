// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/posture/posture.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace marey::reconstruct {
namespace {

using B = HumanBone;

struct LengthRow {
  Length length;
  B bone;  ///< The bone whose offset from its parent the row defines.
  glm::dvec3 direction;
};

// Lengths that both sides share have two rows.
constexpr std::size_t kLengthRows = kLengthCount + 4;

const std::array<LengthRow, kLengthRows>& length_rows() {
  static const std::array<LengthRow, kLengthRows> rows{{
      {Length::kSpine, B::kSpine, {0, 1, 0}},
      {Length::kChest, B::kChest, {0, 1, 0}},
      {Length::kUpperChest, B::kUpperChest, {0, 1, 0}},
      {Length::kNeck, B::kNeck, {0, 1, 0}},
      {Length::kHead, B::kHead, {0, 1, 0}},
      {Length::kHalfHipWidth, B::kLeftUpperLeg, {1, 0, 0}},
      {Length::kHalfHipWidth, B::kRightUpperLeg, {-1, 0, 0}},
      {Length::kShoulderOut, B::kLeftShoulder, {1, 0, 0}},
      {Length::kShoulderOut, B::kRightShoulder, {-1, 0, 0}},
      {Length::kShoulderUp, B::kLeftShoulder, {0, 1, 0}},
      {Length::kShoulderUp, B::kRightShoulder, {0, 1, 0}},
      {Length::kShoulderForward, B::kLeftShoulder, {0, 0, 1}},
      {Length::kShoulderForward, B::kRightShoulder, {0, 0, 1}},
      {Length::kNeckForward, B::kNeck, {0, 0, 1}},
      {Length::kLeftShoulder, B::kLeftUpperArm, {1, 0, 0}},
      {Length::kRightShoulder, B::kRightUpperArm, {-1, 0, 0}},
      {Length::kLeftUpperArm, B::kLeftLowerArm, {1, 0, 0}},
      {Length::kRightUpperArm, B::kRightLowerArm, {-1, 0, 0}},
      {Length::kLeftLowerArm, B::kLeftHand, {1, 0, 0}},
      {Length::kRightLowerArm, B::kRightHand, {-1, 0, 0}},
      {Length::kLeftUpperLeg, B::kLeftLowerLeg, {0, -1, 0}},
      {Length::kRightUpperLeg, B::kRightLowerLeg, {0, -1, 0}},
      {Length::kLeftLowerLeg, B::kLeftFoot, {0, -1, 0}},
      {Length::kRightLowerLeg, B::kRightFoot, {0, -1, 0}},
  }};
  return rows;
}

}  // namespace

Posture::Posture() {
  for (const PoseParameter parameter : kAllPoseParameters) {
    if (is_rotation(parameter)) block(parameter)[3] = 1.0;
  }
}

glm::dquat Posture::rotation(PoseParameter parameter) const {
  const double* q = block(parameter);
  return {q[3], q[0], q[1], q[2]};
}

void Posture::set_rotation(PoseParameter parameter, const glm::dquat& world_from_bone) {
  double* q = block(parameter);
  q[0] = world_from_bone.x;
  q[1] = world_from_bone.y;
  q[2] = world_from_bone.z;
  q[3] = world_from_bone.w;
}

std::vector<PoseParameter> parameters_of(HumanBone bone) {
  using S = PoseParameter;
  const auto trunk = [](std::initializer_list<PoseParameter> more) {
    std::vector<PoseParameter> parameters{
        S::kHipsPosition, S::kHips, S::kAbdomenEnd, S::kThorax};
    parameters.insert(parameters.end(), more);
    return parameters;
  };
  switch (bone) {
    case B::kHips:
      return {S::kHipsPosition, S::kHips};
    case B::kSpine:
    case B::kChest:
      return {S::kHipsPosition, S::kHips, S::kAbdomenEnd};
    case B::kUpperChest:
      return trunk({});
    case B::kNeck:
      return trunk({S::kNeck});
    case B::kHead:
      return trunk({S::kNeck, S::kHead});
    case B::kLeftShoulder:
      return trunk({S::kLeftShoulder});
    case B::kRightShoulder:
      return trunk({S::kRightShoulder});
    case B::kLeftUpperArm:
      return trunk({S::kLeftShoulder, S::kLeftArm, S::kLeftElbow, S::kLeftUpperArmTwist});
    case B::kLeftLowerArm:
      return trunk({S::kLeftShoulder, S::kLeftArm, S::kLeftElbow, S::kLeftForearmTwist});
    case B::kLeftHand:
      return trunk({S::kLeftShoulder, S::kLeftArm, S::kLeftHand, S::kLeftElbow});
    case B::kRightUpperArm:
      return trunk(
          {S::kRightShoulder, S::kRightArm, S::kRightElbow, S::kRightUpperArmTwist});
    case B::kRightLowerArm:
      return trunk(
          {S::kRightShoulder, S::kRightArm, S::kRightElbow, S::kRightForearmTwist});
    case B::kRightHand:
      return trunk({S::kRightShoulder, S::kRightArm, S::kRightHand, S::kRightElbow});
    case B::kLeftUpperLeg:
      return {S::kHipsPosition, S::kHips, S::kLeftLeg, S::kLeftKnee, S::kLeftThighTwist};
    case B::kLeftLowerLeg:
      return {S::kHipsPosition, S::kHips, S::kLeftLeg, S::kLeftKnee, S::kLeftShankTwist};
    case B::kLeftFoot:
    case B::kLeftToes:
      return {S::kHipsPosition, S::kHips, S::kLeftLeg, S::kLeftFoot, S::kLeftKnee};
    case B::kRightUpperLeg:
      return {
          S::kHipsPosition, S::kHips, S::kRightLeg, S::kRightKnee, S::kRightThighTwist};
    case B::kRightLowerLeg:
      return {
          S::kHipsPosition, S::kHips, S::kRightLeg, S::kRightKnee, S::kRightShankTwist};
    case B::kRightFoot:
    case B::kRightToes:
      return {S::kHipsPosition, S::kHips, S::kRightLeg, S::kRightFoot, S::kRightKnee};
  }
  return {};
}

Proportions to_proportions(const Lengths& lengths,
                           const BodyConstants& frame,
                           const Proportions& like) {
  Proportions p = like;
  for (const LengthRow& row : length_rows()) p[row.bone] = glm::dvec3(0.0);
  for (const LengthRow& row : length_rows()) {
    p[row.bone] += lengths[index(row.length)] * row.direction;
  }
  const double drop = -frame.hips_above_hip_centres_m;
  p[B::kLeftUpperLeg].y = drop;
  p[B::kRightUpperLeg].y = drop;
  return p;
}

Lengths lengths_of(const Proportions& proportions) {
  Lengths lengths{};
  for (const LengthRow& row : length_rows()) {
    lengths[index(row.length)] = glm::dot(proportions[row.bone], row.direction);
  }
  return lengths;
}

std::optional<Length> length_of(HumanBone bone) {
  // The start of a clavicle is three numbers, none of them its length.
  if (bone == B::kLeftShoulder || bone == B::kRightShoulder) return std::nullopt;
  for (const LengthRow& row : length_rows()) {
    if (row.bone == bone) return row.length;
  }
  return std::nullopt;
}

BodyConstants body_constants(const Proportions& proportions) {
  return {-proportions[B::kLeftUpperLeg].y, {}};
}

BodyConstants body_constants(const Body& body) {
  BodyConstants frame = body_constants(body.proportions);
  frame.hinges = body.hinges;
  return frame;
}

RigidTransform world_from_bone(HumanBone bone,
                               const Posture& posture,
                               const Lengths& lengths,
                               const BodyConstants& body) {
  std::array<const double*, kPoseParameterCount> blocks{};
  for (const PoseParameter parameter : kAllPoseParameters)
    blocks[index(parameter)] = posture.block(parameter);
  const BoneFrame<double> frame =
      bone_frame<double, double>(bone, blocks, lengths.data(), body);
  return {glm::normalize(glm::dquat(frame.rotation.w(),
                                    frame.rotation.x(),
                                    frame.rotation.y(),
                                    frame.rotation.z())),
          {frame.origin.x(), frame.origin.y(), frame.origin.z()}};
}

void copy_limb(std::size_t limb, const Posture& from, Posture& to) {
  const LimbParameters& s = kLimbParameters[limb];
  for (const PoseParameter parameter :
       {s.frame, s.flexion, s.upper_twist, s.lower_twist, s.extremity}) {
    std::copy_n(from.block(parameter), block_size(parameter), to.block(parameter));
  }
}

Pose to_pose(const Posture& posture,
             const Skeleton& skeleton,
             const Lengths& lengths,
             const BodyConstants& body) {
  std::array<glm::dquat, kHumanBoneCount> world_from_joint{};
  glm::dvec3 root(0.0);
  for (const HumanBone bone : human_bones()) {
    HumanBone mover = bone;
    if (bone == B::kLeftToes) mover = B::kLeftFoot;
    if (bone == B::kRightToes) mover = B::kRightFoot;
    const RigidTransform frame = world_from_bone(mover, posture, lengths, body);
    world_from_joint[index(bone)] = frame.rotation;
    if (bone == B::kHips) root = frame.translation;
  }
  return pose_from_world(skeleton, root, world_from_joint);
}

}  // namespace marey::reconstruct
