// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/vmc_body.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "tests/live/vmc/unity_receiver.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/count_allocations.h"

namespace marey::live {
namespace {

using testing::Dice;

// Rounding down a chain of ten joints.
constexpr double kRounding_m = 1e-11;

/// A body with fingers, a twist joint, and a node above the hips, every axis turned.
Skeleton any_body(Dice& dice) {
  Skeleton body = testing::with_extra_joints(testing::random_humanoid(dice));
  for (Joint& joint : body.joints) {
    if (joint.parent) {
      joint.parent = JointIndex{static_cast<int>(index(*joint.parent)) + 1};
    }
  }
  Joint above;
  above.name = "Armature";
  above.parent_from_joint = {dice.turn(2.0), {0.1, 0.2, -0.3}};
  body.joints[0].parent = JointIndex{0};
  body.joints[0].parent_from_joint =
      inverse(above.parent_from_joint) * body.joints[0].parent_from_joint;
  body.joints.insert(body.joints.begin(), above);
  return testing::with_random_axes(body, dice);
}

/// Returns a pose that rotates every joint, including joints that are not bones.
Pose any_pose(const Skeleton& body, Dice& dice) {
  Pose pose = rest_pose(body);
  for (glm::dquat& rotation : pose.parent_from_joint) rotation *= dice.turn(1.0);
  pose.root_in_world += 0.5 * dice.direction();
  return pose;
}

/// The joints that are no bones as they rest.
Pose with_resting_others(const Skeleton& body, Pose pose) {
  for (std::size_t i = 0; i < body.joints.size(); ++i) {
    if (body.joints[i].bone) continue;
    pose.parent_from_joint[i] = body.joints[i].parent_from_joint.rotation;
  }
  return pose;
}

std::vector<glm::dquat> rotations(std::span<const RigidTransform> frames) {
  std::vector<glm::dquat> out;
  for (const RigidTransform& frame : frames) out.push_back(frame.rotation);
  return out;
}

/// Another rest for the same body: what it was at rest is its T-pose.
struct AnyRest {
  Skeleton body;
  std::vector<glm::dquat> t_pose_from_joint;
};
AnyRest with_any_rest(const Skeleton& t_posed, Dice& dice) {
  AnyRest out{t_posed, rotations(world_from_joints(t_posed, rest_pose(t_posed)))};
  for (Joint& joint : out.body.joints) joint.parent_from_joint.rotation *= dice.turn(0.8);
  return out;
}

/// `t_pose_from_joint`: what normalising took away from each joint's rotation; empty:
/// nothing.
void expect_shown(const Skeleton& body,
                  const Pose& pose,
                  const std::vector<glm::dmat4>& shown,
                  std::span<const glm::dquat> t_pose_from_joint = {}) {
  const glm::dmat3 mirror(-1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
  const auto world = world_from_joints(body, pose);
  for (std::size_t i = 0; i < world.size(); ++i) {
    if (!body.joints[i].bone) continue;
    const glm::dvec3 p = world[i].translation;
    EXPECT_LT(glm::distance(glm::dvec3(shown[i][3]), mirror * p), kRounding_m)
        << body.joints[i].name;
    glm::dmat3 turned = glm::mat3_cast(world[i].rotation);
    if (!t_pose_from_joint.empty()) {
      turned = turned * glm::transpose(glm::mat3_cast(t_pose_from_joint[i]));
    }
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LT(
          glm::distance(glm::dvec3(shown[i][axis]), (mirror * turned * mirror)[axis]),
          1e-11)
          << body.joints[i].name;
    }
  }
}

TEST(VmcBody, RawMatchesTheAvatarsOwnNodesInUnity) {
  Dice dice(1);
  for (int i = 0; i < 10; ++i) {
    const Skeleton body = any_body(dice);
    const VmcBody vmc = *VmcBody::make(body, {.rest = VmcRest::kRaw});
    const Pose pose = any_pose(body, dice);
    VmcPose sent;
    vmc.to_vmc(pose, sent);
    expect_shown(body, pose, shown_in_unity(body, unity_nodes(body), sent));
  }
}

TEST(VmcBody, Vrm0MatchesANormalisedAvatarInUnity) {
  Dice dice(2);
  for (int i = 0; i < 10; ++i) {
    const Skeleton t_posed = any_body(dice);
    const AnyRest rest = with_any_rest(t_posed, dice);
    const VmcBody vmc =
        *VmcBody::make(rest.body, {.t_pose_from_joint = rest.t_pose_from_joint});
    const Pose pose = any_pose(rest.body, dice);
    VmcPose sent;
    vmc.to_vmc(pose, sent);
    expect_shown(rest.body,
                 pose,
                 shown_in_unity(t_posed, normalised_unity_nodes(t_posed), sent),
                 rest.t_pose_from_joint);
  }
}

// A VRM 0.x: importers mirror Z of the file's nodes, whose body faces -Z.
TEST(VmcBody, RawOfAFileThatFacesBackIsItsNodesWithZMirrored) {
  Dice dice(11);
  const RigidTransform half_turn{{0.0, 0.0, 1.0, 0.0}, {}};
  const auto mirrored_z = [](const RigidTransform& local) {
    const glm::dvec3& p = local.translation;
    const glm::dquat& q = local.rotation;
    return RigidTransform{{q.w, -q.x, -q.y, q.z}, {p.x, p.y, -p.z}};
  };
  // With a node above the hips, which is turned round with the body, and without one.
  for (const bool node_above : {true, false}) {
    const Skeleton body = node_above ? any_body(dice) : testing::random_humanoid(dice);
    const RigidTransform file_from_above{dice.turn(1.0), {0.1, 0.2, -0.3}};
    const VmcBody vmc = *VmcBody::make(body,
                                       {.rest = VmcRest::kRaw,
                                        .file_from_root_parent = file_from_above,
                                        .file_faces_back = true});
    const Pose pose = with_resting_others(body, any_pose(body, dice));
    VmcPose sent;
    vmc.to_vmc(pose, sent);
    for (std::size_t i = 0; i < body.joints.size(); ++i) {
      const Joint& joint = body.joints[i];
      if (!joint.bone || (node_above && joint.bone == HumanBone::kHips)) continue;
      RigidTransform node{pose.parent_from_joint[i], joint.parent_from_joint.translation};
      if (!joint.parent) {
        node.translation = pose.root_in_world;
        node = inverse(half_turn * file_from_above) * node;
      }
      const RigidTransform expected = mirrored_z(node);
      const UnityTransform& got = sent.local[index(unity_bone(*joint.bone))];
      EXPECT_LT(glm::distance(got.position, expected.translation), kRounding_m)
          << joint.name;
      EXPECT_NEAR(std::abs(glm::dot(got.rotation, expected.rotation)), 1.0, 1e-12)
          << joint.name;
    }
    Pose again;
    vmc.from_vmc(sent, again);
    const auto before = world_from_joints(body, pose);
    const auto after = world_from_joints(body, again);
    for (std::size_t k = node_above ? 1 : 0; k < after.size(); ++k) {
      EXPECT_LT(glm::distance(after[k].translation, before[k].translation), kRounding_m);
    }
  }
}

// The file has a node above the hips that the skeleton lacks.
TEST(VmcBody, RawKnowsOfANodeAboveTheFirstJoint) {
  Dice dice(10);
  const Skeleton body = testing::random_humanoid(dice);
  const RigidTransform world_from_above{dice.turn(2.0), {0.1, 0.2, -0.3}};
  const VmcBody vmc = *VmcBody::make(
      body, {.rest = VmcRest::kRaw, .file_from_root_parent = world_from_above});
  const Pose pose = any_pose(body, dice);
  VmcPose sent;
  vmc.to_vmc(pose, sent);
  const UnityTransform& hips = sent.local[index(UnityBone::kHips)];
  const RigidTransform above_from_hips{mirrored_x(hips.rotation),
                                       mirrored_x(hips.position)};
  const RigidTransform world_from_hips = world_from_above * above_from_hips;
  EXPECT_LT(glm::distance(world_from_hips.translation, pose.root_in_world), kRounding_m);
  EXPECT_NEAR(std::abs(glm::dot(world_from_hips.rotation, pose.parent_from_joint[0])),
              1.0,
              1e-12);
  Pose again;
  vmc.from_vmc(sent, again);
  EXPECT_LT(glm::distance(again.root_in_world, pose.root_in_world), kRounding_m);
  EXPECT_NEAR(std::abs(glm::dot(again.parent_from_joint[0], pose.parent_from_joint[0])),
              1.0,
              1e-12);
}

TEST(VmcBody, SendsIdentityInTheTPoseAndTheAvatarsOwnOffsets) {
  Dice dice(3);
  const Skeleton body = any_body(dice);
  const VmcBody vmc = *VmcBody::make(body);
  VmcPose sent;
  vmc.to_vmc(rest_pose(body), sent);
  const auto nodes = normalised_unity_nodes(body);
  for (std::size_t i = 0; i < body.joints.size(); ++i) {
    if (!body.joints[i].bone) continue;
    const UnityTransform& local = sent.local[index(unity_bone(*body.joints[i].bone))];
    EXPECT_NEAR(std::abs(local.rotation.w), 1.0, 1e-14);
    EXPECT_LT(glm::distance(local.position, glm::dvec3(nodes[i][3])), kRounding_m);
  }
}

// A hand computation: the left arm straight down is, in Unity, a turn of the left upper
// arm by +90 degrees about Z.
TEST(VmcBody, SendsALoweredLeftArmAsAQuarterTurnAboutZ) {
  const Skeleton body = make_humanoid(average_proportions(1.7));
  Pose pose = rest_pose(body);
  pose.parent_from_joint[index(HumanBone::kLeftUpperArm)] =
      rotation_from_vector({0.0, 0.0, -glm::radians(90.0)});
  VmcPose sent;
  VmcBody::make(body)->to_vmc(pose, sent);
  const glm::dquat arm = sent.local[index(UnityBone::kLeftUpperArm)].rotation;
  EXPECT_NEAR(arm.w, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(arm.z, std::sqrt(0.5), 1e-12);
  // The left hand is at -X.
  EXPECT_LT(sent.local[index(UnityBone::kLeftLowerArm)].position.x, -0.1);
}

TEST(VmcBody, SendsOnlyTheBonesOfTheBody) {
  Dice dice(4);
  const Skeleton body = testing::without(any_body(dice), HumanBone::kUpperChest);
  const VmcBody vmc = *VmcBody::make(body);
  VmcPose sent;
  sent.set(UnityBone::kJaw, {});
  vmc.to_vmc(rest_pose(body), sent);
  EXPECT_EQ(sent.has.count(), 21U);
  EXPECT_EQ(vmc.bones().size(), 21U);
  EXPECT_FALSE(sent.contains(UnityBone::kUpperChest));
  for (const HumanBone bone : human_bones()) {
    EXPECT_TRUE(sent.contains(unity_bone(bone)) || !is_required(bone));
  }
}

TEST(VmcBody, RecoversThePoseFromItsOwnOutput) {
  Dice dice(5);
  for (const VmcRest kind : {VmcRest::kVrm0, VmcRest::kRaw}) {
    for (int i = 0; i < 10; ++i) {
      const AnyRest rest = with_any_rest(any_body(dice), dice);
      VmcBodyOptions options{.rest = kind};
      Pose pose = any_pose(rest.body, dice);
      if (kind == VmcRest::kVrm0) {
        options.t_pose_from_joint = rest.t_pose_from_joint;
        const Pose t_pose =
            pose_from_world(rest.body, glm::dvec3(0.0), rest.t_pose_from_joint);
        for (std::size_t k = 0; k < rest.body.joints.size(); ++k) {
          if (rest.body.joints[k].bone) continue;
          pose.parent_from_joint[k] = t_pose.parent_from_joint[k];
        }
      } else {
        pose = with_resting_others(rest.body, pose);
      }
      const VmcBody vmc = *VmcBody::make(rest.body, options);
      VmcPose sent;
      Pose again;
      vmc.to_vmc(pose, sent);
      vmc.from_vmc(sent, again);
      const auto expected = world_from_joints(rest.body, pose);
      const auto got = world_from_joints(rest.body, again);
      for (std::size_t k = 0; k < got.size(); ++k) {
        EXPECT_LT(glm::distance(got[k].translation, expected[k].translation),
                  kRounding_m);
        EXPECT_NEAR(
            std::abs(glm::dot(got[k].rotation, expected[k].rotation)), 1.0, 1e-12);
      }
    }
  }
}

TEST(VmcBody, MovesTheWholeBodyWithTheRoot) {
  Dice dice(6);
  const Skeleton body = any_body(dice);
  for (const VmcRest kind : {VmcRest::kVrm0, VmcRest::kRaw}) {
    const VmcBody vmc = *VmcBody::make(body, {.rest = kind});
    const Pose pose = with_resting_others(body, any_pose(body, dice));
    VmcPose sent;
    Pose again;
    vmc.to_vmc(pose, sent);
    const RigidTransform root{dice.turn(2.0), {0.3, -0.2, 0.1}};
    sent.root = {mirrored_x(root.translation), mirrored_x(root.rotation)};
    vmc.from_vmc(sent, again);
    const auto before = world_from_joints(body, pose);
    const auto after = world_from_joints(body, again);
    for (std::size_t k = 1; k < after.size(); ++k) {
      EXPECT_LT(glm::distance(after[k].translation, root * before[k].translation),
                kRounding_m);
    }
  }
}

TEST(VmcBody, GivesWhatALackedBoneTurnsToTheBonesBelow) {
  const Skeleton whole = make_humanoid(average_proportions(1.7));
  const Skeleton lacking = testing::without(testing::without(whole, HumanBone::kChest),
                                            HumanBone::kUpperChest);
  Dice dice(7);
  Pose pose = rest_pose(whole);
  for (glm::dquat& rotation : pose.parent_from_joint) rotation = dice.turn(1.0);
  VmcPose sent;
  Pose shown;
  VmcBody::make(whole)->to_vmc(pose, sent);
  VmcBody::make(lacking)->from_vmc(sent, shown);
  const auto expected = world_from_joints(whole, pose);
  const auto got = world_from_joints(lacking, shown);
  for (std::size_t k = 0; k < got.size(); ++k) {
    const auto same = whole.find(*lacking.joints[k].bone);
    EXPECT_NEAR(
        std::abs(glm::dot(got[k].rotation, expected[index(*same)].rotation)), 1.0, 1e-12);
  }
}

TEST(VmcBody, UsesTheRestPoseForMissingBones) {
  Dice dice(8);
  const Skeleton body = any_body(dice);
  const auto rest = world_from_joints(body, rest_pose(body));
  for (const VmcRest kind : {VmcRest::kVrm0, VmcRest::kRaw}) {
    Pose shown;
    VmcBody::make(body, {.rest = kind})->from_vmc({}, shown);
    const auto got = world_from_joints(body, shown);
    for (std::size_t k = 0; k < got.size(); ++k) {
      EXPECT_LT(glm::distance(got[k].translation, rest[k].translation), kRounding_m);
    }
  }
}

TEST(VmcBody, DeclinesABodyWithoutARequiredBone) {
  const Skeleton body =
      testing::without(make_humanoid(average_proportions(1.7)), HumanBone::kLeftFoot);
  const auto made = VmcBody::make(body);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, Errc::kBadInput);
  EXPECT_NE(made.error().message().find("leftFoot"), std::string::npos);
}

TEST(VmcBody, AllocatesNothingPerFrame) {
  Dice dice(9);
  const Skeleton body = any_body(dice);
  const VmcBody vmc = *VmcBody::make(body);
  const Pose pose = any_pose(body, dice);
  VmcPose sent;
  Pose again;
  vmc.to_vmc(pose, sent);
  vmc.from_vmc(sent, again);
  const long before = testing::allocations();
  for (int i = 0; i < 10; ++i) {
    vmc.to_vmc(pose, sent);
    vmc.from_vmc(sent, again);
  }
  EXPECT_EQ(testing::allocations() - before, 0);
}

}  // namespace
}  // namespace marey::live
