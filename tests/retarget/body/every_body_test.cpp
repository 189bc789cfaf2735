// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// normalize() and expand() on bodies of every build.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/pose.h"
#include "core/transform.h"
#include "retarget/body/normalized_skeleton.h"
#include "tests/retarget/mapped.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

using testing::Dice;
using B = HumanBone;

struct BodyMiss {
  double position_m = 0.0;
  double rotation_rad = 0.0;
};

// Returns the largest error over the joints of two postures of one skeleton.
BodyMiss miss(const Skeleton& skeleton, const Pose& a, const Pose& b) {
  const auto frames_a = world_from_joints(skeleton, a);
  const auto frames_b = world_from_joints(skeleton, b);
  BodyMiss worst;
  for (std::size_t i = 0; i < frames_a.size(); ++i) {
    worst.position_m =
        std::max(worst.position_m,
                 glm::distance(frames_a[i].translation, frames_b[i].translation));
    worst.rotation_rad =
        std::max(worst.rotation_rad,
                 glm::length(rotation_vector(glm::conjugate(frames_a[i].rotation) *
                                             frames_b[i].rotation)));
  }
  return worst;
}

BodyMiss worst_round_trip(const Skeleton& body, Dice& dice, int poses) {
  const BodyMap map = mapped(body);
  BodyMiss worst;
  for (int k = 0; k < poses; ++k) {
    const Pose pose = testing::random_pose(body, dice);
    const BodyMiss m = miss(body, pose, expand(normalize(body, map, pose), body, map));
    worst.position_m = std::max(worst.position_m, m.position_m);
    worst.rotation_rad = std::max(worst.rotation_rad, m.rotation_rad);
  }
  return worst;
}

struct BodyCase {
  const char* name;
  std::function<Skeleton(Dice&)> make;
};

class EveryBody : public ::testing::TestWithParam<BodyCase> {};

// Lossless, in place and in rotation (Kulpa 2005, 1.1.2).
TEST_P(EveryBody, GetsItsOwnPostureBackToAMicrometre) {
  Dice dice(11);
  for (int k = 0; k < 20; ++k) {
    const BodyMiss worst = worst_round_trip(GetParam().make(dice), dice, 50);
    ASSERT_LT(worst.position_m, 1e-6);
    ASSERT_LT(worst.rotation_rad, 1e-6);
  }
}

TEST_P(EveryBody, KeepsItsBoneLengthsUnderAnyPosture) {
  Dice dice(12);
  const Skeleton source = testing::random_humanoid(dice);
  const BodyMap source_map = mapped(source);
  const Skeleton body = GetParam().make(dice);
  const BodyMap map = mapped(body);
  std::vector<RigidTransform> frames(body.joints.size());
  Pose pose;
  for (int k = 0; k < 100; ++k) {
    expand(normalize(source, source_map, testing::random_pose(source, dice)),
           body,
           map,
           frames,
           pose);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const Joint& joint = body.joints[i];
      if (!joint.parent) continue;
      const double length =
          glm::distance(frames[i].translation, frames[index(*joint.parent)].translation);
      ASSERT_NEAR(length, glm::length(joint.parent_from_joint.translation), 1e-9);
    }
  }
}

// The frames that expand() returns are those of the pose that it returns.
TEST_P(EveryBody, HasWorldFramesThatAgreeWithItsPose) {
  Dice dice(13);
  const Skeleton source = testing::random_humanoid(dice);
  const Skeleton body = GetParam().make(dice);
  const BodyMap map = mapped(body);
  std::vector<RigidTransform> frames(body.joints.size());
  Pose pose;
  expand(normalize(source, mapped(source), testing::random_pose(source, dice)),
         body,
         map,
         frames,
         pose);
  const auto again = world_from_joints(body, pose);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_LT(glm::distance(frames[i].translation, again[i].translation), 1e-9);
  }
}

// Source and avatar differ in everything except the posture of their limbs.
TEST_P(EveryBody, PointsItsLimbsAsTheSourceDoes) {
  Dice dice(14);
  const Skeleton source = testing::random_humanoid(dice);
  const BodyMap source_map = mapped(source);
  const Skeleton body = GetParam().make(dice);
  const BodyMap map = mapped(body);
  for (int k = 0; k < 50; ++k) {
    const NormalizedPose posture =
        normalize(source, source_map, testing::random_pose(source, dice));
    const auto frames = world_from_joints(body, expand(posture, body, map));
    for (std::size_t i = 0; i < 4; ++i) {
      if (!map.limbs[i]) continue;
      const LimbMap& limb = *map.limbs[i];
      const double shortest = std::abs(limb.upper_length_m - limb.lower_length_m);
      if (posture.limbs[i]->extension * limb.length_m() < shortest) continue;
      const glm::dvec3 end =
          frames[index(limb.end)].translation - frames[index(limb.upper)].translation;
      ASSERT_LT(glm::distance(end / limb.length_m(), posture.limbs[i]->end_from_root()),
                1e-7);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Normalize,
    EveryBody,
    ::testing::Values(
        BodyCase{"Plain", [](Dice& d) { return testing::random_humanoid(d); }},
        BodyCase{"RandomAxes",
                 [](Dice& d) {
                   return testing::with_random_axes(testing::random_humanoid(d), d);
                 }},
        BodyCase{"APoseWithRandomAxes",
                 [](Dice& d) {
                   return testing::with_random_axes(
                       testing::in_a_pose(testing::random_humanoid(d), 0.8), d);
                 }},
        BodyCase{"OneVertebra",
                 [](Dice& d) {
                   return testing::with_vertebrae(testing::random_humanoid(d), 1);
                 }},
        BodyCase{"SevenVertebrae",
                 [](Dice& d) {
                   return testing::with_vertebrae(testing::random_humanoid(d), 7);
                 }},
        BodyCase{
            "NoClaviclesNoToes",
            [](Dice& d) {
              Skeleton s = testing::random_humanoid(d);
              for (const B bone :
                   {B::kLeftShoulder, B::kRightShoulder, B::kLeftToes, B::kRightToes}) {
                s = testing::without(s, bone);
              }
              return s;
            }},
        BodyCase{"NoUpperChestNoNeck",
                 [](Dice& d) {
                   return testing::without(
                       testing::without(testing::random_humanoid(d), B::kUpperChest),
                       B::kNeck);
                 }},
        BodyCase{"HalfAnArm",
                 [](Dice& d) {
                   return testing::without(testing::random_humanoid(d), B::kLeftHand);
                 }},
        BodyCase{"FingersAndTwistJoints",
                 [](Dice& d) {
                   return testing::with_random_axes(
                       testing::with_extra_joints(testing::random_humanoid(d)), d);
                 }}),
    [](const auto& case_info) { return std::string(case_info.param.name); });

}  // namespace
}  // namespace marey::retarget
