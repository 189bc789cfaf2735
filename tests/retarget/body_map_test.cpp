// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/body_map.h"

#include <gtest/gtest.h>

#include "tests/retarget/mapped.h"
#include "tests/support/random_bodies.h"

namespace marey::retarget {
namespace {

using B = HumanBone;

TEST(MapBody, SaysWhichBoneIsMissing) {
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

}  // namespace
}  // namespace marey::retarget
