// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/vrchat_trackers.h"

#include <map>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "tests/live/vmc/read_vmc.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/count_allocations.h"

namespace marey::live {
namespace {

using Said = std::map<std::string, glm::dvec3>;

Said said(std::span<const std::uint8_t> packet) {
  Said all;
  for (const ReadMessage& message : read_by_liblo(packet)) {
    EXPECT_EQ(message.types, "fff");
    all[message.address] = {message.numbers[0], message.numbers[1], message.numbers[2]};
  }
  return all;
}

/// Unity's order by matrices: about z first, then x, then y.
glm::dmat4 turned_about_zxy(const glm::dvec3& rad) {
  const glm::dmat4 one(1.0);
  return glm::rotate(one, rad.y, {0.0, 1.0, 0.0}) *
         glm::rotate(one, rad.x, {1.0, 0.0, 0.0}) *
         glm::rotate(one, rad.z, {0.0, 0.0, 1.0});
}

double largest_difference(const glm::dmat4& a, const glm::dmat4& b) {
  double largest = 0.0;
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) largest = std::max(largest, std::abs(a[i][k] - b[i][k]));
  }
  return largest;
}

TEST(ZxyAngles, AreOfTheRotationTheyCameFrom) {
  testing::Dice dice(1);
  for (int i = 0; i < 100; ++i) {
    const glm::dquat rotation = dice.turn(3.14);
    EXPECT_LT(largest_difference(turned_about_zxy(zxy_angles(rotation)),
                                 glm::mat4_cast(rotation)),
              1e-12);
  }
}

TEST(ZxyAngles, HaveNoTurnAboutZWhereItIsOneWithY) {
  for (const double x_deg : {90.0, -90.0}) {
    const glm::dvec3 given = glm::radians(glm::dvec3(x_deg, 30.0, 20.0));
    const glm::dquat rotation = glm::quat_cast(turned_about_zxy(given));
    const glm::dvec3 angles = zxy_angles(rotation);
    EXPECT_EQ(angles.z, 0.0);
    EXPECT_LT(largest_difference(turned_about_zxy(angles), glm::mat4_cast(rotation)),
              1e-7);
  }
}

TEST(VrchatTrackers, StandAtTheJointsAndAreNotTurnedInTheTPose) {
  testing::Dice dice(2);
  const Skeleton body = testing::with_random_axes(testing::random_humanoid(dice), dice);
  VrchatTrackers trackers(body);
  EXPECT_EQ(trackers.count(), 9U);
  const auto rest = world_from_joints(body, rest_pose(body));
  const Said all = said(trackers.encode(rest));
  EXPECT_EQ(all.size(), 18U);
  const std::map<std::string, HumanBone> places{{"1", HumanBone::kHips},
                                                {"2", HumanBone::kUpperChest},
                                                {"3", HumanBone::kLeftFoot},
                                                {"4", HumanBone::kRightFoot},
                                                {"5", HumanBone::kLeftLowerLeg},
                                                {"6", HumanBone::kRightLowerLeg},
                                                {"7", HumanBone::kLeftLowerArm},
                                                {"8", HumanBone::kRightLowerArm},
                                                {"head", HumanBone::kHead}};
  for (const auto& [number, bone] : places) {
    const std::string address = "/tracking/trackers/" + number;
    const glm::dvec3 p = rest[index(*body.find(bone))].translation;
    EXPECT_LT(glm::distance(all.at(address + "/position"), {-p.x, p.y, p.z}), 1e-6);
    EXPECT_LT(glm::length(all.at(address + "/rotation")), 1e-5);
  }
}

// In Unity a positive turn about x tips forward, about y turns to the right.
TEST(VrchatTrackers, SendEulerAnglesInUnityAxes) {
  const Skeleton body = make_humanoid(average_proportions(1.7));
  Pose pose = rest_pose(body);
  // A quarter turn to the right (clockwise from above), after a bow by 30 degrees.
  pose.parent_from_joint[0] = rotation_from_vector({0.0, -glm::radians(90.0), 0.0}) *
                              rotation_from_vector({glm::radians(30.0), 0.0, 0.0});
  VrchatTrackers trackers(body, {.head = false});
  const Said all = said(trackers.encode(world_from_joints(body, pose)));
  const glm::dvec3 angles = all.at("/tracking/trackers/1/rotation");
  EXPECT_LT(glm::distance(angles, {30.0, 90.0, 0.0}), 1e-4);
  EXPECT_EQ(all.count("/tracking/trackers/head/position"), 0U);
}

TEST(VrchatTrackers, TurnWithTheBoneAboveTheJoint) {
  const Skeleton body = make_humanoid(average_proportions(1.7));
  Pose pose = rest_pose(body);
  pose.parent_from_joint[index(HumanBone::kLeftLowerLeg)] =
      rotation_from_vector({1.0, 0.0, 0.0});
  const auto world = world_from_joints(body, pose);
  VrchatTrackers trackers(body);
  const Said all = said(trackers.encode(world));
  EXPECT_LT(glm::length(all.at("/tracking/trackers/5/rotation")), 1e-5);
  EXPECT_GT(glm::length(all.at("/tracking/trackers/3/rotation")), 50.0);
}

TEST(VrchatTrackers, OmitUnwantedAndMissingTrackers) {
  Skeleton body = make_humanoid(average_proportions(1.7));
  VrchatTrackers few(body,
                     {.knees = false, .elbows = false, .chest = false, .head = false});
  EXPECT_EQ(few.count(), 3U);
  body = testing::without(body, HumanBone::kUpperChest);
  EXPECT_EQ(VrchatTrackers(body).count(), 9U);
  body = testing::without(body, HumanBone::kChest);
  EXPECT_EQ(VrchatTrackers(body).count(), 8U);
  body = testing::without(testing::without(body, HumanBone::kHead), HumanBone::kNeck);
  EXPECT_EQ(VrchatTrackers(body).count(), 7U);
}

TEST(VrchatTrackers, AllocateNothingAfterTheFirstFrame) {
  const Skeleton body = make_humanoid(average_proportions(1.7));
  const auto world = world_from_joints(body, rest_pose(body));
  VrchatTrackers trackers(body);
  (void)trackers.encode(world);
  const long before = testing::allocations();
  EXPECT_LE(trackers.encode(world).size(), 1472U);
  EXPECT_EQ(testing::allocations() - before, 0);
}

}  // namespace
}  // namespace marey::live
