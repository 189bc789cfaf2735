// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body/body_map.h"

#include <gtest/gtest.h>

#include "tests/retarget/mapped.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

TEST(MapBody, ReportsTheMissingBone) {
  const auto map = map_body(testing::without(testing::child(), B::kLeftLowerLeg));
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().message(),
            "skeleton: no joint is marked leftLowerLeg. Next: map the bone to one of the "
            "skeleton's joints.");
}

TEST(MapBody, DeclinesALegWithoutLength) {
  Skeleton body = testing::child();
  body.joints[index(*body.find(B::kLeftFoot))].parent_from_joint.translation = {0, 0, 0};
  const auto map = map_body(body);
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().cause, "the limb of leftUpperLeg has no length");
}

TEST(MapBody, FindsTheSoleOfABodyThatRestsAtTheOrigin) {
  Skeleton body = testing::child();
  const double ankle_m = mapped(body).feet[0].ankle_height_m;
  body.joints[0].parent_from_joint.translation = {0, 0, 0};
  const BodyMap map = mapped(body);
  // The toe joints become the lowest points, 2 % of the hips' height lower than they are.
  EXPECT_NEAR(map.feet[0].ankle_height_m, ankle_m, 0.03);
  EXPECT_GT(map.feet[0].ankle_height_m, 0.01);
}

// A sole is on the floor from behind the ankle to below the tip of the toes.
TEST(BodyMap, KnowsWhereSolesEnd) {
  const Skeleton body = testing::giant();
  const BodyMap map = *map_body(body);
  const auto rest = world_from_joints(body, rest_pose(body));
  for (int side = 0; side < 2; ++side) {
    const FootMap& foot = map.feet[static_cast<std::size_t>(side)];
    EXPECT_NEAR(foot.heel_from_ankle_in_t_pose.y, -foot.ankle_height_m, 1e-12);
    EXPECT_LT(foot.heel_from_ankle_in_t_pose.z, -0.02);
    EXPECT_NEAR(foot.tip_from_ball_in_t_pose.y, -foot.ball_height_m, 1e-12);
    const JointIndex toes =
        *map.joint_of[index(side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes)];
    EXPECT_NEAR(foot.tip_from_ball_in_t_pose.z, body[toes].tip_in_joint->z, 1e-12);
  }
}

// Files without a toe tip write one of zero length: it is estimated as if it were absent.
TEST(BodyMap, GuessesToesWhoseTipIsNoFurtherThanTheirJoint) {
  Skeleton with_tips = testing::giant();
  Skeleton without_tips = with_tips;
  for (const HumanBone bone : {HumanBone::kLeftToes, HumanBone::kRightToes}) {
    with_tips.joints[index(*with_tips.find(bone))].tip_in_joint = glm::dvec3(0.0);
    without_tips.joints[index(*without_tips.find(bone))].tip_in_joint.reset();
  }
  const FootMap foot = map_body(with_tips)->feet[0];
  EXPECT_GT(foot.tip_from_ball_in_t_pose.z, 0.05);
  EXPECT_EQ(foot.tip_from_ball_in_t_pose.z,
            map_body(without_tips)->feet[0].tip_from_ball_in_t_pose.z);
}

}  // namespace
}  // namespace marey::retarget
