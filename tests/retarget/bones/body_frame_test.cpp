// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/bones/body_frame.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/transform.h"
#include "retarget/body/body_map.h"
#include "retarget/bones/identify_bones.h"
#include "tests/support/bodies/quadruped.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

constexpr double kQuarter = 1.5707963267948966;

Skeleton adult() {
  return make_humanoid(average_proportions(1.75));
}

/// A file's body: marey's, turned and in another unit.
Motion in_file(const Skeleton& body,
               const glm::dquat& file_from_marey,
               double per_metre) {
  Motion motion;
  motion.skeleton = body;
  for (Joint& joint : motion.skeleton.joints) {
    joint.parent_from_joint.translation *= per_metre;
    if (joint.tip_in_joint) *joint.tip_in_joint *= per_metre;
  }
  RigidTransform& root = motion.skeleton.joints[0].parent_from_joint;
  root = {file_from_marey * root.rotation, file_from_marey * root.translation};
  return motion;
}

FoundBones bones_of(const Skeleton& body) {
  auto found = identify_bones(body);
  EXPECT_TRUE(found) << (found ? "" : found.error().message());
  return found ? *std::move(found) : FoundBones{};
}

BodyFrame frame_of(const Skeleton& body, const FileUnit& unit = {}) {
  FoundBones found = bones_of(body);
  auto frame = find_body_frame(body, unit, {}, found);
  EXPECT_TRUE(frame) << (frame ? "" : frame.error().message());
  return frame ? *std::move(frame) : BodyFrame{};
}

std::string cause(const Skeleton& body, const BoneMap& overrides = {}) {
  auto found = identify_bones(body, overrides);
  EXPECT_TRUE(found) << (found ? "" : found.error().message());
  if (!found) return {};
  const auto frame = find_body_frame(body, {}, overrides, *found);
  EXPECT_FALSE(frame);
  return frame ? "" : frame.error().cause;
}

double worst_place_m(const Skeleton& a, const Skeleton& b) {
  const auto in_a = world_from_joints(a, rest_pose(a));
  const auto in_b = world_from_joints(b, rest_pose(b));
  double worst = 0.0;
  for (std::size_t i = 0; i < in_a.size(); ++i) {
    worst = std::max(worst, glm::distance(in_a[i].translation, in_b[i].translation));
  }
  return worst;
}

TEST(BodyFrame, LeavesABodyThatStandsAsMareysToTheBit) {
  testing::Dice dice(3);
  for (const Skeleton& body : {adult(),
                               testing::child(),
                               testing::giant(),
                               testing::in_a_pose(adult(), 0.8),
                               testing::random_humanoid(dice)}) {
    EXPECT_TRUE(frame_of(body).is_marey());
  }
}

// All 24 orientations of axes, and three units. Truth: the body before it was turned.
TEST(BodyFrame, BringsABodyBackFromAnyAxesAndUnit) {
  const Skeleton truth = testing::in_a_pose(adult(), 0.7);
  for (int up = 0; up < 6; ++up) {
    for (int turn = 0; turn < 4; ++turn) {
      glm::dvec3 axis(0.0);
      axis[up % 3] = up < 3 ? 1.0 : -1.0;
      const glm::dquat file_from_marey = glm::normalize(
          glm::angleAxis(turn * kQuarter, axis) * rotation_between({0, 1, 0}, axis));
      for (const double per_metre : {1.0, 100.0, 1000.0, 1.0 / 0.0254}) {
        Motion motion = in_file(truth, file_from_marey, per_metre);
        const BodyFrame frame = frame_of(motion.skeleton);
        EXPECT_NEAR(frame.unit_m, 1.0 / per_metre, 1e-12);
        put_into_frame(frame, motion);
        EXPECT_LT(worst_place_m(motion.skeleton, truth), 1e-9);
        EXPECT_EQ(frame.remarks.empty(), per_metre == 1.0);
      }
    }
  }
}

TEST(BodyFrame, TakesCmusUnitWhereTheFormatDoesNotStateOne) {
  const Motion motion = in_file(adult(), {1, 0, 0, 0}, 0.01 / (0.0254 / 0.45));
  EXPECT_NEAR(frame_of(motion.skeleton, {0.01, false}).unit_m, 0.0254 / 0.45, 1e-12);
  // A doll in a format that states metres keeps its size.
  EXPECT_EQ(frame_of(motion.skeleton, {1.0, true}).scale, 1.0);
}

TEST(BodyFrame, TurnsAMotionAsItsBody) {
  const glm::dquat file_from_marey = rotation_between({0, 1, 0}, {0, 0, 1});
  testing::Dice dice(5);
  Motion truth;
  truth.skeleton = adult();
  for (int i = 0; i < 10; ++i) {
    truth.poses.push_back(testing::random_pose(truth.skeleton, dice));
  }
  Motion motion = in_file(truth.skeleton, file_from_marey, 100.0);
  for (Pose pose : truth.poses) {
    pose.root_in_world = file_from_marey * (100.0 * pose.root_in_world);
    pose.parent_from_joint[0] = file_from_marey * pose.parent_from_joint[0];
    motion.poses.push_back(pose);
  }
  put_into_frame(frame_of(motion.skeleton), motion);
  for (std::size_t i = 0; i < truth.poses.size(); ++i) {
    const auto a = world_from_joints(truth.skeleton, truth.poses[i]);
    const auto b = world_from_joints(motion.skeleton, motion.poses[i]);
    for (std::size_t j = 0; j < a.size(); ++j) {
      EXPECT_LT(glm::distance(a[j].translation, b[j].translation), 1e-9);
    }
  }
}

// A body without names gets its sides by its toes, whatever its orientation.
TEST(BodyFrame, FindsTheSidesOfAShapeByItsToes) {
  for (const double turn : {0.0, 1.0, 2.0, 3.0}) {
    const Skeleton truth = adult();
    Motion motion =
        in_file(truth, glm::angleAxis(turn * kQuarter, glm::dvec3(0, 1, 0)), 1);
    for (Joint& joint : motion.skeleton.joints) {
      joint.name.clear();
      joint.bone.reset();
    }
    FoundBones found = bones_of(motion.skeleton);
    ASSERT_TRUE(find_body_frame(motion.skeleton, {}, {}, found));
    for (const B bone : human_bones()) {
      ASSERT_TRUE(found.joint(bone)) << name(bone);
      EXPECT_EQ(truth[*found.joint(bone)].bone, bone) << name(bone);
    }
  }
}

TEST(BodyFrame, DeclinesAFrontThatPointsUp) {
  BoneMap overrides;
  overrides.front = glm::dvec3(0, 1, 0);
  EXPECT_NE(cause(adult(), overrides).find("\"front\" is not across the body's up"),
            std::string::npos);
}

TEST(BodyFrame, DeclinesLeftThatIsRight) {
  Skeleton body = adult();
  for (Joint& joint : body.joints) joint.bone = mirrored(*joint.bone);
  EXPECT_EQ(
      cause(body),
      "'rightUpperLeg' is identified as leftUpperLeg but is on the right of the body, "
      "whose toes point to +Z");
  BoneMap overrides;
  overrides.front = glm::dvec3(0, 0, -1);
  EXPECT_EQ(
      cause(adult(), overrides),
      "'leftUpperLeg' is identified as leftUpperLeg but is on the right of the body, "
      "whose front is set in the bone map");
}

TEST(BodyFrame, DeclinesFourLegsNamingOne) {
  Skeleton animal = testing::make_quadruped().skeleton;
  for (Joint& joint : animal.joints) joint.bone.reset();
  const std::string said = cause(animal);
  EXPECT_NE(said.find("the body stands on four legs: 'front"), std::string::npos) << said;
}

TEST(BodyFrame, DeclinesARestThatIsNoPosture) {
  Skeleton body = adult();
  body.joints[index(*body.find(B::kLeftLowerLeg))].parent_from_joint.translation *= -1.0;
  body.joints[index(*body.find(B::kLeftFoot))].parent_from_joint.translation *= -1.0;
  const FoundBones found = bones_of(body);
  EXPECT_FALSE(stands_at_rest(body, found));
  EXPECT_NE(cause(body).find("at rest the feet 'leftFoot'"), std::string::npos);
}

}  // namespace
}  // namespace marey::retarget
