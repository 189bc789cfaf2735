// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/match_carriage.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/humanoid.h"
#include "core/pose.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/retarget/mapped.h"
#include "tests/support/simulation/synthetic_walk.h"
#include "tests/support/truth/segment_directions.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

glm::dquat forward(double degrees) {
  return glm::angleAxis(glm::radians(degrees), glm::dvec3(1, 0, 0));
}

glm::dvec3& offset_of(Skeleton& body, B bone) {
  return body.joints[index(*body.find(bone))].parent_from_joint.translation;
}

/// Makes a rig of the same body whose neck leans at rest, and whose hip joints lie so far
/// before the spine that the line to its shoulders leans back.
Skeleton leaning(double neck_deg, double trunk_deg) {
  Skeleton body = make_humanoid(average_proportions(1.75));
  glm::dvec3& head = offset_of(body, B::kHead);
  head = forward(neck_deg) * head;
  const auto world = world_from_joints(body, rest_pose(body));
  const double trunk_m = world[index(*body.find(B::kLeftUpperArm))].translation.y -
                         world[index(*body.find(B::kLeftUpperLeg))].translation.y;
  for (const B thigh : {B::kLeftUpperLeg, B::kRightUpperLeg}) {
    offset_of(body, thigh).z += trunk_m * std::tan(glm::radians(trunk_deg));
  }
  return body;
}

testing::DirectionErrors errors_on(const Skeleton& avatar) {
  const Motion walk = testing::synthetic_walk(60, 60.0).motion;
  const auto made = retarget_motion(walk, avatar);
  EXPECT_TRUE(made) << (made ? "" : made.error().message());
  return testing::compare_directions(walk,
                                     testing::marked_joints(walk.skeleton),
                                     made->motion,
                                     testing::marked_joints(avatar));
}

double worst_deg(const testing::DirectionErrors& errors, testing::Segment segment) {
  return glm::degrees(*errors.worst_rad[static_cast<std::size_t>(segment)]);
}

TEST(MatchCarriage, TurnsALeaningNeckTowardsTheSources) {
  for (const double lean_deg : {-20.0, 8.0, 13.0, 20.0}) {
    const auto errors = errors_on(leaning(lean_deg, 0.0));
    EXPECT_LT(worst_deg(errors, testing::Segment::kNeck), 3.5) << lean_deg;
    EXPECT_LT(worst_deg(errors, testing::Segment::kTrunk), 1.0) << lean_deg;
  }
}

TEST(MatchCarriage, TurnsATrunkWithOtherHipJointsTowardsTheSources) {
  for (const double lean_deg : {-12.0, 9.0, 14.0}) {
    const auto errors = errors_on(leaning(0.0, lean_deg));
    EXPECT_LT(worst_deg(errors, testing::Segment::kTrunk), 5.0) << lean_deg;
    EXPECT_LT(worst_deg(errors, testing::Segment::kNeck), 1.0) << lean_deg;
  }
}

TEST(MatchCarriage, KeepsTheHeadAndSmallDifferences) {
  const Skeleton source = make_humanoid(average_proportions(1.75));
  const Skeleton body = leaning(20.0, 10.0);
  const BodyMap own = mapped(body);
  BodyMap map = own;
  match_carriage(source, mapped(source), body, map);
  const auto turned_deg = [&](B bone) {
    const std::size_t joint = index(*body.find(bone));
    const glm::dquat by = map.joints[joint].t_pose_from_joint *
                          glm::conjugate(own.joints[joint].t_pose_from_joint);
    return glm::degrees(2.0 * std::acos(std::min(1.0, std::abs(by.w))));
  };
  EXPECT_NEAR(turned_deg(B::kNeck), 17.0, 0.1);
  EXPECT_GT(turned_deg(B::kChest), 6.0);
  for (const B bone : {B::kHead, B::kHips, B::kLeftUpperArm, B::kLeftUpperLeg}) {
    EXPECT_LT(turned_deg(bone), 1e-4) << name(bone);
  }
  // Differences of less than three degrees stay.
  const Skeleton near = leaning(2.5, 2.5);
  const BodyMap before = mapped(near);
  BodyMap after = before;
  match_carriage(source, mapped(source), near, after);
  for (std::size_t i = 0; i < before.joints.size(); ++i) {
    EXPECT_EQ(before.joints[i].t_pose_from_joint, after.joints[i].t_pose_from_joint);
  }
}

}  // namespace
}  // namespace marey::retarget
