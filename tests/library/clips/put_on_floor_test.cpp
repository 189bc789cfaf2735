// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/clips/put_on_floor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/motion.h"
#include "tests/library/moved_motion.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::library {
namespace {

Motion lifted(Motion motion, double height_m) {
  for (Pose& pose : motion.poses) pose.root_in_world.y += height_m;
  return motion;
}

Motion standing_still(int frames, double hz) {
  Motion motion;
  motion.skeleton = make_humanoid(average_proportions(1.75));
  motion.rate.hz = hz;
  motion.poses.assign(static_cast<std::size_t>(frames), rest_pose(motion.skeleton));
  return motion;
}

// On the floor after each flight for `stand_s`.
Motion hopping(double hz, double flight_s, double stand_s) {
  Motion motion = standing_still(static_cast<int>(4.0 * hz), hz);
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    const double time_s = std::fmod(static_cast<double>(t) / hz, flight_s + stand_s);
    const double up_m = 0.5 * 9.81 * time_s * (flight_s - time_s);
    motion.poses[t].root_in_world.y += std::max(0.0, up_m);
  }
  return motion;
}

retarget::BodyMap map_of_motion(const Motion& motion) {
  auto map = retarget::map_body(motion.skeleton);
  EXPECT_TRUE(map.has_value());
  return *map;
}

TEST(PutOnFloor, PutsAWalkFromAnyHeightOnTheFloor) {
  for (const double hz : {30.0, 60.0, 120.0}) {
    const Motion walk =
        testing::synthetic_walk(static_cast<int>(4.0 * hz), hz, 0.002, 0.001).motion;
    const auto map = map_of_motion(walk);
    for (const double height_m : {0.0, 0.03, -0.95, 40.0}) {
      Motion motion = lifted(walk, height_m);
      const auto floor_m = floor_height_m(motion, map);
      ASSERT_TRUE(floor_m);
      EXPECT_NEAR(*floor_m, height_m, 0.008);
      EXPECT_NEAR(put_on_floor(motion, map), -*floor_m, 1e-12);
      EXPECT_NEAR(*floor_height_m(motion, map), 0.0, 1e-12);
    }
  }
}

TEST(PutOnFloor, IsThatOfTheSolesForAnInstant) {
  const Motion motion = lifted(standing_still(1, 30.0), 0.4);
  EXPECT_NEAR(*floor_height_m(motion, map_of_motion(motion)), 0.4, 1e-9);
}

TEST(PutOnFloor, ScalesWithTheBody) {
  const Motion walk = lifted(testing::synthetic_walk(120, 30.0).motion, 0.2);
  const Motion large = scaled(walk, 1.3);
  EXPECT_NEAR(*floor_height_m(large, map_of_motion(large)),
              1.3 * *floor_height_m(walk, map_of_motion(walk)),
              1e-9);
}

TEST(PutOnFloor, IgnoresFlights) {
  const Motion motion = lifted(hopping(60.0, 0.4, 0.5), -0.7);
  EXPECT_NEAR(*floor_height_m(motion, map_of_motion(motion)), -0.7, 0.003);
}

TEST(PutOnFloor, UsesTouchdownsThatAreTooShortForContacts) {
  const Motion motion = lifted(hopping(60.0, 0.4, 0.03), -0.7);
  EXPECT_NEAR(*floor_height_m(motion, map_of_motion(motion)), -0.7, 0.03);
}

TEST(PutOnFloor, IsUnknownIfTheBodyOnlyFalls) {
  Motion motion = standing_still(30, 60.0);
  for (std::size_t t = 0; t < motion.poses.size(); ++t) {
    const double time_s = static_cast<double>(t) / 60.0;
    motion.poses[t].root_in_world.y += 2.0 * time_s - 0.5 * 9.81 * time_s * time_s;
  }
  const auto map = map_of_motion(motion);
  EXPECT_FALSE(floor_height_m(motion, map));
  const double before_m = motion.poses[3].root_in_world.y;
  EXPECT_EQ(put_on_floor(motion, map), 0.0);
  EXPECT_EQ(motion.poses[3].root_in_world.y, before_m);
  motion.poses.clear();
  EXPECT_FALSE(floor_height_m(motion, map));
}

// The hips' joint of an average adult who lies on the back is half the depth of a pelvis
// above the floor, or that of the chest or the head if they are deeper.
TEST(PutOnFloor, IsBelowTheBackOfALyingBody) {
  for (const int frames : {1, 5, 60}) {
    Motion motion = standing_still(frames, 30.0);
    for (Pose& pose : motion.poses) {
      pose.root_in_world = {0.0, 0.5, 0.0};
      pose.parent_from_joint[0] =
          glm::angleAxis(-0.5 * std::numbers::pi, glm::dvec3(1.0, 0.0, 0.0)) *
          pose.parent_from_joint[0];
    }
    const double depth_m = 0.5 - *floor_height_m(motion, map_of_motion(motion));
    EXPECT_GT(depth_m, 0.08);
    EXPECT_LT(depth_m, 0.18);
  }
}

// The hands of an average adult who stands on them are the lowest point.
TEST(PutOnFloor, IsBelowTheHandsOfAHandstand) {
  Motion motion = standing_still(60, 30.0);
  const std::size_t left = index(*motion.skeleton.find(HumanBone::kLeftUpperArm));
  const std::size_t right = index(*motion.skeleton.find(HumanBone::kRightUpperArm));
  const glm::dvec3 forward(0.0, 0.0, 1.0);
  for (Pose& pose : motion.poses) {
    pose.root_in_world = {0.0, 1.0, 0.0};
    pose.parent_from_joint[0] = glm::angleAxis(std::numbers::pi, forward);
    pose.parent_from_joint[left] = glm::angleAxis(0.5 * std::numbers::pi, forward);
    pose.parent_from_joint[right] = glm::angleAxis(-0.5 * std::numbers::pi, forward);
  }
  std::vector<RigidTransform> world(motion.skeleton.joints.size());
  world_from_joints(motion.skeleton, motion.poses[0], world);
  const std::size_t hand = index(*motion.skeleton.find(HumanBone::kLeftHand));
  const double below_wrist_m =
      world[hand].translation.y - *floor_height_m(motion, map_of_motion(motion));
  EXPECT_GT(below_wrist_m, 0.1);
  EXPECT_LT(below_wrist_m, 0.25);
}

}  // namespace
}  // namespace marey::library
