// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/find_soles.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/pose.h"
#include "retarget/feet/leg_placement.h"
#include "retarget/motion/live_retarget.h"
#include "retarget/motion/retarget_motion.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::retarget {
namespace {

// Feet as boxes: 9 cm behind the ankle and 12 cm in front of the ball.
struct Shoes {
  Skeleton body;
  BodyMap map;
  std::vector<glm::dvec3> places;
  std::vector<JointIndex> carriers;

  explicit Shoes(Skeleton skeleton) : body(std::move(skeleton)), map(*map_body(body)) {
    const auto rest = world_from_joints(body, rest_pose(body));
    for (std::size_t side = 0; side < 2; ++side) {
      const JointIndex ankle = map.leg(static_cast<int>(side)).end;
      const JointIndex toes =
          *map.joint_of[index(side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes)];
      const glm::dquat world_from_t_pose =
          rest[index(ankle)].rotation *
          glm::conjugate(map.joints[index(ankle)].t_pose_from_joint);
      const auto add = [&](JointIndex joint, const glm::dvec3& from_joint_in_t_pose) {
        places.push_back(rest[index(joint)].translation +
                         world_from_t_pose * from_joint_in_t_pose);
        carriers.push_back(joint);
      };
      for (const double x : {-0.04, 0.04}) {
        add(ankle, {x, -map.feet[side].ankle_height_m, -0.09});
        add(ankle, {x, 0.0, 0.0});
        add(toes, {x, -map.feet[side].ball_height_m, 0.12});
      }
      // A long boot leg is not a sole.
      add(ankle, {0.0, 0.2, -0.5});
    }
  }
};

TEST(FindSoles, EndWhereTheSkinDoes) {
  testing::Dice dice(4);
  for (const Skeleton& body :
       {testing::giant(), testing::with_random_axes(testing::giant(), dice)}) {
    const Shoes shoes(body);
    const Soles soles = find_soles(shoes.body, shoes.map, shoes.places, shoes.carriers);
    for (std::size_t side = 0; side < 2; ++side) {
      ASSERT_TRUE(soles[side]);
      EXPECT_NEAR(soles[side]->heel_from_ankle_in_t_pose.z, -0.09, 1e-9);
      EXPECT_NEAR(soles[side]->tip_from_ball_in_t_pose.z, 0.12, 1e-9);
      EXPECT_NEAR(soles[side]->tip_from_ball_in_t_pose.y,
                  -shoes.map.feet[side].ball_height_m,
                  1e-9);
    }
  }
}

// Without skin on the toe joint a shoe does not bend: its front end turns with the foot.
TEST(FindSoles, ShoesWithoutSkinOnTheToesDoNotBend) {
  Shoes shoes(testing::giant());
  Soles soles = find_soles(shoes.body, shoes.map, shoes.places, shoes.carriers);
  ASSERT_TRUE(soles[0]);
  EXPECT_TRUE(soles[0]->toes_bend);
  for (const HumanBone toes : {HumanBone::kLeftToes, HumanBone::kRightToes}) {
    const JointIndex joint = *shoes.map.joint_of[index(toes)];
    for (JointIndex& carrier : shoes.carriers) {
      if (carrier == joint) carrier = *shoes.body[joint].parent;
    }
  }
  soles = find_soles(shoes.body, shoes.map, shoes.places, shoes.carriers);
  for (std::size_t side = 0; side < 2; ++side) {
    ASSERT_TRUE(soles[side]);
    EXPECT_FALSE(soles[side]->toes_bend);
    EXPECT_NEAR(soles[side]->tip_from_ball_in_t_pose.z, 0.12, 1e-9);
  }
  apply_soles(soles, shoes.map);
  EXPECT_FALSE(shoes.map.feet[0].has_toes);
  // On its ball with the heel up: the tip reaches the floor, the ankle stays.
  const FootMap& foot = shoes.map.feet[0];
  const glm::dquat pitch = glm::angleAxis(0.7, glm::dvec3(1, 0, 0));
  FootPlace place{-(pitch * foot.ball_from_ankle_in_t_pose), pitch, pitch};
  place.ankle_in_world.y += foot.ball_height_m;
  const glm::dvec3 ankle = place.ankle_in_world;
  const auto tip_m = [&] {
    return place.ankle_in_world.y +
           (place.foot * (foot.ball_from_ankle_in_t_pose + foot.tip_from_ball_in_t_pose))
               .y;
  };
  EXPECT_LT(tip_m(), -0.02);
  keep_tip_up(foot, place);
  EXPECT_NEAR(tip_m(), 0.0, 1e-9);
  EXPECT_EQ(place.ankle_in_world, ankle);
  const glm::dquat before = place.foot;
  keep_tip_up(foot, place);
  EXPECT_GT(std::abs(glm::dot(before, place.foot)), 1.0 - 1e-12);
}

TEST(FindSoles, NoneWithoutSkin) {
  const Skeleton body = testing::child();
  const Soles soles = find_soles(body, *map_body(body), {}, {});
  EXPECT_FALSE(soles[0]);
  EXPECT_FALSE(soles[1]);
}

TEST(FindSoles, LongShoesStayAboveTheFloor) {
  const Motion walk = testing::synthetic_walk(200, 60.0).motion;
  const Shoes shoes(testing::giant());
  const Soles soles = find_soles(shoes.body, shoes.map, shoes.places, shoes.carriers);
  BodyMap map = shoes.map;
  apply_soles(soles, map);

  RetargetOptions options;
  options.soles = soles;
  const auto out = retarget_motion(walk, shoes.body, options);
  ASSERT_TRUE(out);
  EXPECT_LT(measure_feet(out->motion, map, out->report.contacts).max_penetration_mm, 1.0);
  const auto bare = retarget_motion(walk, shoes.body);
  ASSERT_TRUE(bare);
  EXPECT_GT(measure_feet(bare->motion, map, bare->report.contacts).max_penetration_mm,
            5.0);

  LiveRetargetOptions live_options;
  live_options.soles = soles;
  auto live = LiveRetarget::make(walk.skeleton, shoes.body, live_options);
  ASSERT_TRUE(live);
  Motion motion{shoes.body, walk.rate, 0, {}};
  for (const Pose& pose : walk.poses) {
    motion.poses.emplace_back();
    live->step(pose, 1.0 / 60.0, motion.poses.back());
  }
  EXPECT_LT(measure_feet(motion, map, out->report.contacts).max_penetration_mm, 1.0);
}

}  // namespace
}  // namespace marey::retarget
