// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Invariants of a normalized posture (Kulpa 2005, 1.1.2), on random bodies and postures.
#include <cmath>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "core/transform.h"
#include "retarget/body/normalized_skeleton.h"
#include "tests/retarget/mapped.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

using testing::Dice;
using B = HumanBone;

constexpr std::array kRoots{RootNormalization::kLegLength,
                            RootNormalization::kArmLength,
                            RootNormalization::kNone};

double angle_between(const glm::dquat& a, const glm::dquat& b) {
  return glm::length(rotation_vector(glm::conjugate(a) * b));
}

// Returns the maximum displacement of a joint after a round trip, over `poses` random
// ones. [m]
double worst_return_m(const Skeleton& body,
                      Dice& dice,
                      int poses,
                      RootNormalization root = RootNormalization::kLegLength) {
  const BodyMap map = mapped(body);
  double worst_m = 0.0;
  for (int k = 0; k < poses; ++k) {
    const Pose pose = testing::random_pose(body, dice);
    const auto before = world_from_joints(body, pose);
    const auto after =
        world_from_joints(body, expand(normalize(body, map, pose, root), body, map));
    for (std::size_t i = 0; i < before.size(); ++i) {
      worst_m =
          std::max(worst_m, glm::distance(before[i].translation, after[i].translation));
    }
  }
  return worst_m;
}

class AnySpine : public ::testing::TestWithParam<int> {};

TEST_P(AnySpine, GetsItsOwnPostureBack) {
  Dice dice(61);
  for (int k = 0; k < 10; ++k) {
    const Skeleton body = testing::with_random_axes(
        testing::with_vertebrae(testing::random_humanoid(dice), GetParam()), dice);
    EXPECT_LT(worst_return_m(body, dice, 20), 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Normalize, AnySpine, ::testing::Range(1, 16));

// More than kMaxVertebrae in a section is an error, not cut off.
TEST(NormalizedLaws, TakeThirtyVertebraeAndRefuseThirtyTwo) {
  Dice dice(62);
  const Skeleton plain = testing::random_humanoid(dice);
  EXPECT_LT(worst_return_m(testing::with_vertebrae(plain, 2 * kMaxVertebrae), dice, 20),
            1e-6);
  const auto map = map_body(testing::with_vertebrae(plain, 2 * kMaxVertebrae + 2));
  ASSERT_FALSE(map);
  EXPECT_NE(map.error().cause.find("32 vertebrae"), std::string::npos);
}

// Every set of bones that a body may lack, on one side or both.
TEST(NormalizedLaws, LoseNothingOfBodiesThatLackBones) {
  Dice dice(63);
  const std::vector<std::vector<B>> lacks{
      {B::kLeftShoulder},
      {B::kLeftShoulder, B::kRightShoulder},
      {B::kRightToes},
      {B::kLeftToes, B::kRightToes},
      {B::kNeck},
      {B::kNeck, B::kHead},
      {B::kNeck, B::kLeftShoulder, B::kRightShoulder, B::kLeftToes, B::kRightToes},
      {B::kSpine, B::kChest, B::kUpperChest},
      {B::kLeftUpperArm, B::kLeftLowerArm, B::kLeftHand}};
  for (const std::vector<B>& lacking : lacks) {
    std::string words;
    Skeleton body = testing::random_humanoid(dice);
    for (const B bone : lacking) {
      body = testing::without(body, bone);
      words += std::string(name(bone)) + " ";
    }
    EXPECT_LT(worst_return_m(body, dice, 50), 1e-6) << words;
  }
}

TEST(NormalizedLaws, LoseNothingHoweverTheRootIsNormalized) {
  Dice dice(64);
  for (const RootNormalization root : kRoots) {
    for (int k = 0; k < 10; ++k) {
      EXPECT_LT(worst_return_m(testing::random_humanoid(dice), dice, 20, root), 1e-6);
    }
  }
}

// Limbs at the edge of their range, turned about themselves: the half-plane of straight
// ones and the direction of folded ones are undefined.
TEST(NormalizedLaws, LoseNothingOfStraightAndFoldedLimbs) {
  Dice dice(68);
  for (int k = 0; k < 50; ++k) {
    // Both bones of a leg are of one length, so that the ankle can be in the hip.
    Proportions proportions = average_proportions(dice.between(1.0, 2.2));
    for (const B shank : {B::kLeftFoot, B::kRightFoot}) {
      proportions[shank] = proportions[B::kLeftLowerLeg];
    }
    const Skeleton body = make_humanoid(proportions);
    const BodyMap map = mapped(body);
    for (const double bend_rad : {0.0, 1e-9, 1e-6, 1e-3, 3.141592, 3.14159265358979}) {
      Pose pose = testing::random_pose(body, dice);
      for (const auto& limb : map.limbs) {
        const glm::dquat twist =
            glm::angleAxis(dice.between(-2, 2), limb->along_in_t_pose);
        pose.parent_from_joint[index(limb->lower)] =
            glm::angleAxis(bend_rad, limb->hinge_in_t_pose) * twist;
      }
      const auto before = world_from_joints(body, pose);
      const auto after =
          world_from_joints(body, expand(normalize(body, map, pose), body, map));
      for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_LT(glm::distance(before[i].translation, after[i].translation), 1e-6)
            << bend_rad << " " << body.joints[i].name;
        EXPECT_LT(angle_between(before[i].rotation, after[i].rotation), 1e-6)
            << bend_rad << " " << body.joints[i].name;
      }
    }
  }
}

Skeleton scaled(Skeleton skeleton, double by) {
  for (Joint& joint : skeleton.joints) {
    joint.parent_from_joint.translation *= by;
    if (joint.tip_in_joint) *joint.tip_in_joint *= by;
  }
  return skeleton;
}

// Expects two postures with the same limbs, curves and segments.
void expect_alike(const NormalizedPose& a, const NormalizedPose& b) {
  for (std::size_t i = 0; i < 4; ++i) {
    ASSERT_EQ(a.limbs[i].has_value(), b.limbs[i].has_value());
    if (!a.limbs[i]) continue;
    const NormalizedLimb& m = *a.limbs[i];
    const NormalizedLimb& n = *b.limbs[i];
    // For a nearly stretched limb, its length determines its bend with half the digits.
    EXPECT_NEAR(m.extension, n.extension, 1e-12);
    EXPECT_LT(glm::distance(m.mid_offset, n.mid_offset), 1e-9);
    EXPECT_LT(angle_between(m.world_from_limb, n.world_from_limb), 1e-7);
    EXPECT_NEAR(std::remainder(m.upper_twist_rad - n.upper_twist_rad, 6.283185307179586),
                0.0,
                1e-7);
    EXPECT_NEAR(std::remainder(m.lower_twist_rad - n.lower_twist_rad, 6.283185307179586),
                0.0,
                1e-7);
  }
  for (double at = 0.0; at <= 1.0; at += 0.125) {
    EXPECT_LT(angle_between(sample(a.abdomen, at), sample(b.abdomen, at)), 1e-7);
    EXPECT_LT(angle_between(sample(a.torso, at), sample(b.torso, at)), 1e-7);
  }
  for (std::size_t i = 0; i < a.segments.size(); ++i) {
    ASSERT_EQ(a.segments[i].has_value(), b.segments[i].has_value());
    if (!a.segments[i]) continue;
    EXPECT_LT(angle_between(*a.segments[i], *b.segments[i]), 1e-7);
  }
}

// A body three times as large has the same normalized posture, and its root too when the
// root is divided by a length of the body.
TEST(NormalizedLaws, ForgetTheSizeOfABody) {
  Dice dice(65);
  for (int k = 0; k < 50; ++k) {
    const Skeleton body = testing::random_humanoid(dice);
    const double by = dice.between(0.2, 4.0);
    const Skeleton other = scaled(body, by);
    const Pose pose = testing::random_pose(body, dice);
    Pose large = pose;
    large.root_in_world *= by;
    for (const RootNormalization root : kRoots) {
      const NormalizedPose a = normalize(body, mapped(body), pose, root);
      const NormalizedPose b = normalize(other, mapped(other), large, root);
      expect_alike(a, b);
      const double grown = root == RootNormalization::kNone ? by : 1.0;
      EXPECT_LT(glm::distance(grown * a.root, b.root), 1e-12 * by + 1e-12);
    }
  }
}

glm::dquat reflected(const glm::dquat& q) {
  return {q.w, q.x, -q.y, -q.z};
}

RotationCurve reflected(const RotationCurve& curve) {
  RotationCurve out;
  for (std::size_t i = 0; i < static_cast<std::size_t>(curve.count); ++i) {
    out.add(curve.at[i], reflected(curve.rotation[i]));
  }
  return out;
}

// Reflects in X = 0. A limb's Y is Z x X, and so is turned the other way.
NormalizedLimb reflected(const NormalizedLimb& limb) {
  NormalizedLimb out = limb;
  glm::dmat3 axes = glm::mat3_cast(limb.world_from_limb);
  for (glm::length_t i = 0; i < 3; ++i) axes[i].x *= -1.0;
  axes[1] *= -1.0;
  out.world_from_limb = glm::quat_cast(axes);
  out.mid_offset.y *= -1.0;
  out.upper_twist_rad *= -1.0;
  out.lower_twist_rad *= -1.0;
  return out;
}

NormalizedPose reflected(const NormalizedPose& pose) {
  NormalizedPose out;
  out.root_normalization = pose.root_normalization;
  out.root = pose.root * glm::dvec3(-1, 1, 1);
  for (std::size_t i = 0; i < 4; ++i) {
    if (pose.limbs[i]) out.limbs[i ^ 1U] = reflected(*pose.limbs[i]);
  }
  out.abdomen = reflected(pose.abdomen);
  out.torso = reflected(pose.torso);
  for (const B bone : human_bones()) {
    const auto& segment = pose.segments[index(bone)];
    if (segment) out.segments[index(mirrored(bone))] = reflected(*segment);
  }
  return out;
}

TEST(NormalizedLaws, MirrorThePostureOfAMirroredBody) {
  Dice dice(66);
  for (int k = 0; k < 100; ++k) {
    const Skeleton body = testing::random_humanoid(dice);
    const Skeleton other = testing::mirrored_body(body);
    const Pose pose = testing::random_pose(body, dice);
    Pose pose_m = pose;
    pose_m.root_in_world.x *= -1.0;
    for (glm::dquat& q : pose_m.parent_from_joint) q = reflected(q);
    const NormalizedPose a = normalize(body, mapped(body), pose);
    const NormalizedPose b = normalize(other, mapped(other), pose_m);
    expect_alike(reflected(a), b);
    EXPECT_LT(glm::distance(a.root * glm::dvec3(-1, 1, 1), b.root), 1e-12);
  }
}

// The T-pose is no rotation on any body.
TEST(NormalizedLaws, CallTheTPoseIdentity) {
  Dice dice(67);
  for (int k = 0; k < 20; ++k) {
    const Skeleton plain = make_humanoid(average_proportions(dice.between(1.0, 2.2)));
    const Skeleton body = testing::with_random_axes(plain, dice);
    const NormalizedPose pose = normalize(body, mapped(body), rest_pose(body));
    for (const auto& segment : pose.segments) {
      if (!segment) continue;
      EXPECT_LT(angle_between(*segment, glm::dquat(1, 0, 0, 0)), 1e-7);
    }
    for (const auto& limb : pose.limbs) {
      EXPECT_NEAR(limb->extension, 1.0, 1e-12);
      EXPECT_NEAR(limb->upper_twist_rad, 0.0, 1e-7);
      EXPECT_NEAR(limb->lower_twist_rad, 0.0, 1e-7);
    }
  }
}

}  // namespace
}  // namespace marey::retarget
