// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/motion/joint_angles.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/base/degrees.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "tests/reconstruct/motion/opensim_model.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/count_allocations.h"

namespace marey::reconstruct {
namespace {

using testing::Angles;
using testing::coordinate;
using testing::Dice;
using testing::Model;
using B = HumanBone;
using C = Coordinate;

constexpr double kPi = std::numbers::pi;
const glm::dvec3 kX{1, 0, 0};
const glm::dvec3 kY{0, 1, 0};
const glm::dvec3 kZ{0, 0, 1};

glm::dquat about(const glm::dvec3& axis, double angle_rad) {
  return glm::angleAxis(angle_rad, axis);
}

/// Returns wide swings of every angle, with the middle ones of ball joints below gimbal
/// lock.
Angles swings(double phase) {
  Angles angles{};
  for (std::size_t i = 0; i < kCoordinateCount; ++i) {
    const double at = phase * (1.0 + 0.1 * static_cast<double>(i % 7));
    angles[i] = 1.0 * std::sin(at + static_cast<double>(i));
  }
  for (const char* name_of_one : {"arm_add_r", "arm_add_l", "hip_flexion_r"}) {
    angles[index(coordinate(name_of_one))] *= 1.4;
  }
  return angles;
}

Motion motion_of(const std::vector<Angles>& frames) {
  Motion motion;
  motion.skeleton = make_humanoid(average_proportions(1.75));
  motion.rate = FrameRate{100.0};
  motion.first_frame = 20;
  for (const Angles& angles : frames) {
    motion.poses.push_back(Model(angles).pose(motion.skeleton, {0.3, 0.9, -0.2}));
  }
  return motion;
}

Motion swinging(int frames) {
  std::vector<Angles> all;
  for (int i = 0; i < frames; ++i) all.push_back(swings(0.05 * i));
  return motion_of(all);
}

TEST(JointAngles, NamesAreOpenSims) {
  EXPECT_EQ(name(C::kPelvisTilt), "pelvis_tilt");
  EXPECT_EQ(name(C::kToesRight), "mtp_angle_r");
  EXPECT_EQ(name(C::kHipFlexionLeft), "hip_flexion_l");
  EXPECT_EQ(name(C::kWristDeviationLeft), "wrist_dev_l");
  EXPECT_TRUE(is_angle(C::kPelvisRotation));
  EXPECT_FALSE(is_angle(C::kPelvisTy));
}

TEST(JointAngles, MatchTheAnglesOfTheGeneratedPoses) {
  const Motion motion = swinging(400);
  const JointAngles angles = joint_angles(motion);
  ASSERT_EQ(angles.values.size(), 400 * kCoordinateCount);
  EXPECT_DOUBLE_EQ(angles.time_s[5], 0.25);
  for (int i = 0; i < 400; ++i) {
    const Angles truth = swings(0.05 * i);
    for (std::size_t c = 0; c < kCoordinateCount; ++c) {
      const C one{static_cast<int>(c)};
      if (!is_angle(one)) continue;
      // One over the cosine of the middle angle, at least 0.17, times rounding.
      ASSERT_NEAR(angles.at(static_cast<std::size_t>(i), one), truth[c], 1e-9)
          << name(one) << " in frame " << i;
    }
  }
}

TEST(JointAngles, ThePelvisOriginIsWhereTheModelHasItForThisHipWidth) {
  const Motion motion = swinging(10);
  const JointAngles angles = joint_angles(motion);
  for (std::size_t i = 0; i < 10; ++i) {
    const auto world = world_from_joints(motion.skeleton, motion.poses[i]);
    const auto at = [&](B bone) {
      return world[index(*motion.skeleton.find(bone))].translation;
    };
    const glm::dvec3 left = at(B::kLeftUpperLeg);
    const glm::dvec3 right = at(B::kRightUpperLeg);
    const glm::dquat pelvis =
        Model(swings(0.05 * static_cast<double>(i))).ground_from_pelvis();
    // The right hip in Rajagopal2016's pelvis.
    const glm::dvec3 hip(-0.056276, -0.07849, 0.07726);
    const double scale = glm::distance(left, right) / (2.0 * hip.z);
    const glm::dvec3 p = right - pelvis * (scale * hip);
    EXPECT_NEAR(angles.at(i, C::kPelvisTx), p.x, 1e-12);
    EXPECT_NEAR(angles.at(i, C::kPelvisTy), p.y, 1e-12);
    EXPECT_NEAR(angles.at(i, C::kPelvisTz), p.z, 1e-12);
  }
}

/// Returns the angles of the T-pose with these bones turned about their own axes there.
JointAngles turned(const std::map<B, glm::dquat>& turns) {
  Motion motion;
  motion.skeleton = make_humanoid(average_proportions(1.75));
  motion.rate = FrameRate{100.0};
  Pose pose = rest_pose(motion.skeleton);
  for (const auto& [bone, turn] : turns) {
    pose.parent_from_joint[index(*motion.skeleton.find(bone))] = turn;
  }
  motion.poses.push_back(pose);
  return joint_angles(motion, {.ground_yaw_rad = kPi / 2});
}

TEST(JointAngles, TheTPoseHasArmsOutAndPalmsDown) {
  const JointAngles angles = turned({});
  for (std::size_t c = 0; c < kCoordinateCount; ++c) {
    const C one{static_cast<int>(c)};
    double wanted = 0.0;
    if (one == C::kArmAdductionRight || one == C::kArmAdductionLeft) wanted = -90.0;
    // The model's elbow axis is 13.07 degrees from lateral; palms turn about it as well.
    if (one == C::kPronationRight || one == C::kPronationLeft) wanted = 90.0 + 13.0677;
    if (one == C::kArmRotationRight || one == C::kArmRotationLeft) wanted = -13.0677;
    if (!is_angle(one)) continue;
    EXPECT_NEAR(angles.at(0, one) / kRadiansPerDegree, wanted, 1e-4) << name(one);
  }
}

// Sign of each angle, in rotations of the skeleton's bones: X is its left.
TEST(JointAngles, SignsAreThoseOfTheField) {
  const double a = 20.0 * kRadiansPerDegree;
  const JointAngles legs = turned({{B::kRightUpperLeg, about(-kX, a)},
                                   {B::kRightLowerLeg, about(kX, 2 * a)},
                                   {B::kRightFoot, about(-kX, a)},
                                   {B::kRightToes, about(kX, a)},
                                   {B::kLeftUpperLeg, about(kZ, -a)}});
  EXPECT_NEAR(legs.at(0, C::kHipFlexionRight), a, 1e-12);
  EXPECT_NEAR(legs.at(0, C::kKneeRight), 2 * a, 1e-12);
  EXPECT_NEAR(legs.at(0, C::kAnkleRight), a, 0.1 * a);  // Toes up; an oblique axis.
  // Toes down; an oblique axis as well.
  EXPECT_NEAR(legs.at(0, C::kToesRight), a, 0.2 * a);
  EXPECT_NEAR(legs.at(0, C::kHipAdductionLeft), a, 1e-12);  // To the right.
  const JointAngles turned_in = turned({{B::kRightUpperLeg, about(kY, a)},
                                        {B::kLeftUpperLeg, about(kY, a)},
                                        {B::kRightFoot, about(kZ, a)}});
  EXPECT_NEAR(turned_in.at(0, C::kHipRotationRight), a, 1e-12);  // Inwards.
  EXPECT_NEAR(turned_in.at(0, C::kHipRotationLeft), -a, 1e-12);
  EXPECT_GT(turned_in.at(0, C::kSubtalarRight), 0.5 * a);  // The sole inwards.
  const JointAngles trunk =
      turned({{B::kHips, about(kX, a)}, {B::kUpperChest, about(kZ, a)}});
  EXPECT_NEAR(trunk.at(0, C::kPelvisTilt), -a, 1e-12);    // Forwards.
  EXPECT_NEAR(trunk.at(0, C::kLumbarBending), a, 1e-12);  // To the right.
  const JointAngles heading = turned({{B::kHips, about(kY, a)}});
  EXPECT_NEAR(heading.at(0, C::kPelvisRotation), a, 1e-12);  // To the left.
  // Arms hang, elbows bent forward, palms to the thighs.
  const JointAngles arms = turned({{B::kLeftUpperArm, about(kZ, -90 * kRadiansPerDegree)},
                                   {B::kLeftLowerArm, about(-kY, 3 * a)},
                                   {B::kLeftHand, about(kZ, -a)},
                                   {B::kRightUpperArm, about(kZ, 90 * kRadiansPerDegree)},
                                   {B::kRightHand, about(kY, a)}});
  EXPECT_NEAR(arms.at(0, C::kArmFlexionLeft), 0.0, 1e-12);
  EXPECT_NEAR(arms.at(0, C::kElbowLeft), 3 * a, 1e-12);
  EXPECT_NEAR(arms.at(0, C::kWristFlexionLeft), a, 1e-12);  // Towards the palm.
  EXPECT_NEAR(arms.at(0, C::kPronationLeft), (90.0 + 13.0677) * kRadiansPerDegree, 1e-5);
  EXPECT_NEAR(arms.at(0, C::kWristDeviationRight), -a, 1e-12);  // To the thumb.
}

TEST(JointAngles, AMirroredMotionHasLeftAndRightExchanged) {
  Dice dice(7);
  Motion motion;
  motion.skeleton = make_humanoid(average_proportions(1.6));
  motion.rate = FrameRate{50.0};
  Motion mirrored_motion = motion;
  for (int i = 0; i < 50; ++i) {
    Model model(swings(0.1 * i));
    const Pose pose = model.pose(motion.skeleton, {dice.between(-1, 1), 0.9, 0.3});
    motion.poses.push_back(pose);
    Pose other = pose;
    other.root_in_world.x *= -1.0;
    for (const B bone : human_bones()) {
      const glm::dquat& q = pose.parent_from_joint[index(bone)];
      other.parent_from_joint[index(mirrored(bone))] = {q.w, q.x, -q.y, -q.z};
    }
    mirrored_motion.poses.push_back(other);
  }
  const JointAngles one = joint_angles(motion, {.ground_yaw_rad = kPi / 2});
  const JointAngles other = joint_angles(mirrored_motion, {.ground_yaw_rad = kPi / 2});
  const std::map<std::string, std::string> turned_round{{"pelvis_list", ""},
                                                        {"pelvis_rotation", ""},
                                                        {"pelvis_tz", ""},
                                                        {"lumbar_bending", ""},
                                                        {"lumbar_rotation", ""}};
  for (std::size_t c = 0; c < kCoordinateCount; ++c) {
    std::string there(name(C{static_cast<int>(c)}));
    const double sign = turned_round.contains(there) ? -1.0 : 1.0;
    if (there.ends_with("_r")) {
      there.back() = 'l';
    } else if (there.ends_with("_l")) {
      there.back() = 'r';
    }
    for (std::size_t i = 0; i < 50; ++i) {
      EXPECT_NEAR(
          one.at(i, C{static_cast<int>(c)}), sign * other.at(i, coordinate(there)), 1e-9)
          << there;
    }
  }
}

/// Returns frames in which one angle changes linearly from one value to another.
std::vector<Angles> sweep(const std::string& which, double from, double to, int frames) {
  std::vector<Angles> all(static_cast<std::size_t>(frames));
  for (int i = 0; i < frames; ++i) {
    all[static_cast<std::size_t>(i)][index(coordinate(which))] =
        from + (to - from) * i / (frames - 1);
  }
  return all;
}

TEST(JointAngles, GoOnBeyondHalfATurn) {
  for (const char* which :
       {"pelvis_rotation", "pelvis_tilt", "arm_flex_r", "arm_flex_l"}) {
    const auto frames = sweep(which, 0.0, 4.0 * kPi, 101);
    const JointAngles angles = joint_angles(motion_of(frames));
    for (std::size_t i = 0; i < frames.size(); ++i) {
      for (std::size_t c = 0; c < kCoordinateCount; ++c) {
        if (!is_angle(C{static_cast<int>(c)})) continue;
        ASSERT_NEAR(angles.at(i, C{static_cast<int>(c)}), frames[i][c], 1e-9) << which;
      }
    }
  }
}

// Sideways past the T-pose, where gimbal lock is: frame 54 of 109 is exactly at it.
TEST(JointAngles, AnArmThatIsRaisedSidewaysGoesOnOverhead) {
  auto frames = sweep("arm_add_r", 0.0, -180.0 * kRadiansPerDegree, 109);
  for (Angles& angles : frames) angles[index(C::kArmFlexionRight)] = 0.2;
  const JointAngles angles = joint_angles(motion_of(frames));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    // At the lock itself a tolerance of a millionth is sufficient.
    EXPECT_NEAR(angles.at(i, C::kArmFlexionRight), 0.2, 1e-6) << i;
    EXPECT_NEAR(angles.at(i, C::kArmAdductionRight),
                frames[i][index(C::kArmAdductionRight)],
                1e-6);
    EXPECT_NEAR(angles.at(i, C::kArmRotationRight), 0.0, 1e-6) << i;
  }
}

TEST(JointAngles, TakeLaterValuesInATPoseAtTheStart) {
  auto frames = sweep("arm_add_l", -90.0 * kRadiansPerDegree, 0.0, 50);
  frames.insert(frames.begin(), 20, frames.front());
  for (Angles& angles : frames) angles[index(C::kArmRotationLeft)] = 0.3;
  const JointAngles angles = joint_angles(motion_of(frames));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_NEAR(angles.at(i, C::kArmFlexionLeft), 0.0, 1e-6) << i;
    EXPECT_NEAR(angles.at(i, C::kArmRotationLeft), 0.3, 1e-6) << i;
  }
}

// Noise of 0.2 degrees on every bone of every frame, arms from side to overhead and back
// not quite through the T-pose. Within 25 degrees of the lock noise grows by a factor of
// 10 and more; further away the angles equal the input, without a remaining jump.
TEST(JointAngles, NoiseNearGimbalLockLeavesNothingBehind) {
  auto frames = sweep("arm_add_r", 0.0, -160.0 * kRadiansPerDegree, 200);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i][index(C::kArmFlexionRight)] = 0.1;
  }
  frames.insert(frames.end(), frames.rbegin(), frames.rend());
  Motion motion = motion_of(frames);
  Dice dice(11);
  for (Pose& pose : motion.poses) {
    for (glm::dquat& q : pose.parent_from_joint)
      q = q * dice.turn(0.2 * kRadiansPerDegree);
  }
  const JointAngles angles = joint_angles(motion);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double add = frames[i][index(C::kArmAdductionRight)];
    if (std::abs(add + kPi / 2) < 25.0 * kRadiansPerDegree) continue;
    // The noise of a few bones together, through a cosine of 0.42.
    EXPECT_NEAR(angles.at(i, C::kArmFlexionRight), 0.1, 2.5 * kRadiansPerDegree) << i;
    EXPECT_NEAR(angles.at(i, C::kArmAdductionRight), add, 1.0 * kRadiansPerDegree) << i;
    EXPECT_NEAR(angles.at(i, C::kArmRotationRight), 0.0, 2.5 * kRadiansPerDegree) << i;
  }
}

TEST(JointAngles, TheGroundIsTurnedUntilThePersonFacesAlongX) {
  for (int quarter = -1; quarter < 3; ++quarter) {
    const auto frames = sweep("pelvis_rotation",
                              (quarter * 90 - 20) * kRadiansPerDegree,
                              (quarter * 90 + 30) * kRadiansPerDegree,
                              9);
    const Motion motion = motion_of(frames);
    const double yaw_rad = yaw_to_face_x_rad(motion);
    EXPECT_NEAR(std::remainder(yaw_rad + quarter * kPi / 2, 2 * kPi), 0.0, 1e-12);
    const JointAngles angles = joint_angles(motion, {.ground_yaw_rad = yaw_rad});
    EXPECT_NEAR(angles.at(0, C::kPelvisRotation), -20 * kRadiansPerDegree, 1e-9);
  }
}

TEST(JointAngles, AMotionWithoutFramesHasNone) {
  const JointAngles angles = joint_angles(motion_of({}));
  EXPECT_TRUE(angles.time_s.empty());
  EXPECT_TRUE(angles.values.empty());
}

TEST(JointAngles, TakesAsManyAllocationsForManyFramesAsForFew) {
  const Motion few = swinging(3);
  const Motion many = swinging(300);
  const auto count = [](const Motion& motion) {
    const long before = testing::allocations();
    static_cast<void>(joint_angles(motion));
    return testing::allocations() - before;
  };
  EXPECT_EQ(count(few), count(many));
}

}  // namespace
}  // namespace marey::reconstruct
