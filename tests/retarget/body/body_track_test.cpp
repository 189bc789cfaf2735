// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/body_track.h"

#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "retarget/body/place_masses.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

struct TrackedBody {
  Motion motion;
  BodyMap map;
  std::vector<PointMass> masses;

  explicit TrackedBody(Skeleton skeleton) : map(*map_body(skeleton)) {
    masses = *place_masses(skeleton, map, {});
    motion.skeleton = std::move(skeleton);
    motion.rate = FrameRate{100.0};
  }
  [[nodiscard]] BodyTrack track() const { return body_track(motion, map, masses); }
};

// The floor of a random humanoid's rest is below its ankles by the map's height.
TEST(BodyTrack, AllSolePointsOfAStandingBodyAreOnTheFloor) {
  testing::Dice dice(11);
  for (int k = 0; k < 200; ++k) {
    TrackedBody body(testing::random_humanoid(dice));
    body.motion.poses.push_back(rest_pose(body.motion.skeleton));
    const BodyTrack track = body.track();
    ASSERT_EQ(track.com_in_world.size(), 1U);
    EXPECT_NEAR(track.mass_kg, 70.0, 1e-9);
    const auto joints = world_from_joints(body.motion.skeleton, body.motion.poses[0]);
    for (std::size_t side = 0; side < 2; ++side) {
      const SoleTrack& sole = track.soles[side];
      const double floor_m =
          joints[index(body.map.leg(static_cast<int>(side)).end)].translation.y -
          body.map.feet[side].ankle_height_m;
      EXPECT_NEAR(sole.heel_in_world[0].y, floor_m, 1e-9);
      EXPECT_NEAR(sole.ball_in_world[0].y, floor_m, 1e-9);
      EXPECT_NEAR(sole.tip_in_world[0].y, floor_m, 1e-9);
      EXPECT_LT(sole.heel_in_world[0].z, sole.ball_in_world[0].z);
      EXPECT_LT(sole.ball_in_world[0].z, sole.tip_in_world[0].z);
    }
  }
}

// Rotates about the world's origin and moves by a shift.
Pose displaced(const Pose& pose, const glm::dquat& turn, const glm::dvec3& shift) {
  Pose out = pose;
  out.root_in_world = turn * pose.root_in_world + shift;
  out.parent_from_joint[0] = turn * pose.parent_from_joint[0];
  return out;
}

TEST(BodyTrack, MovesWithTheWholeBody) {
  testing::Dice dice(12);
  for (int k = 0; k < 100; ++k) {
    TrackedBody body(testing::random_humanoid(dice));
    const Pose pose = testing::random_pose(body.motion.skeleton, dice);
    const glm::dquat turn = dice.turn(3.0);
    const glm::dvec3 shift = 3.0 * dice.direction();
    body.motion.poses = {pose, displaced(pose, turn, shift)};
    const BodyTrack track = body.track();
    const auto follows = [&](const std::vector<glm::dvec3>& p) {
      EXPECT_LT(glm::distance(turn * p[0] + shift, p[1]), 1e-9);
    };
    follows(track.com_in_world);
    for (const SoleTrack& sole : track.soles) {
      follows(sole.heel_in_world);
      follows(sole.ball_in_world);
      follows(sole.tip_in_world);
    }
  }
}

// The foot turns about the toe joint while the toes lie flat.
TEST(BodyTrack, ARaisedHeelLeavesBallAndTipOnTheFloor) {
  TrackedBody body(make_humanoid(average_proportions(1.75)));
  const Skeleton& skeleton = body.motion.skeleton;
  const Pose rest = rest_pose(skeleton);
  const glm::dquat raise = glm::angleAxis(0.7, glm::dvec3(1.0, 0.0, 0.0));
  Pose tiptoe = rest;
  tiptoe.parent_from_joint[index(HumanBone::kLeftFoot)] =
      raise * rest.parent_from_joint[index(HumanBone::kLeftFoot)];
  tiptoe.parent_from_joint[index(HumanBone::kLeftToes)] =
      glm::conjugate(raise) * rest.parent_from_joint[index(HumanBone::kLeftToes)];
  const auto flat = world_from_joints(skeleton, rest);
  const auto bent = world_from_joints(skeleton, tiptoe);
  const std::size_t toes = index(HumanBone::kLeftToes);
  const glm::dvec3 lift = flat[toes].translation - bent[toes].translation;
  tiptoe.root_in_world += lift;
  body.motion.poses = {rest, tiptoe};
  const SoleTrack sole = body.track().soles[0];
  EXPECT_LT(glm::distance(sole.ball_in_world[0], sole.ball_in_world[1]), 1e-9);
  EXPECT_LT(glm::distance(sole.tip_in_world[0], sole.tip_in_world[1]), 1e-9);
  EXPECT_GT(sole.heel_in_world[1].y, 0.05);
}

}  // namespace
}  // namespace marey::retarget
