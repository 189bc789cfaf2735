// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "retarget/com/foot_goals.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/transform.h"
#include "retarget/body/normalized_skeleton.h"
#include "retarget/feet/leg_placement.h"
#include "tests/retarget/com/com_scenes.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::retarget {
namespace {

TEST(FootGoals, AreThePlacesOfTheNormalizedPostures) {
  for (int seed = 0; seed < 100; ++seed) {
    const HeavyBody body = heavy_body(static_cast<std::uint64_t>(seed));
    testing::Dice dice(100 + static_cast<std::uint64_t>(seed));
    Motion motion{body.skeleton, {60.0}, 0, {}};
    for (int t = 0; t < 5; ++t) {
      motion.poses.push_back(testing::random_pose(body.skeleton, dice));
    }
    for (int side = 0; side < 2; ++side) {
      const auto places = foot_places(motion, body.map, side);
      ASSERT_EQ(places.size(), motion.poses.size());
      for (std::size_t t = 0; t < places.size(); ++t) {
        const auto joints = world_from_joints(body.skeleton, motion.poses[t]);
        NormalizedPose posture;
        normalize(body.map, joints, posture, RootNormalization::kNone);
        const FootPlace expected = foot_of(body.map, posture, joints, side);
        EXPECT_EQ(places[t].ankle_in_world, expected.ankle_in_world);
        EXPECT_EQ(places[t].foot, expected.foot);
        EXPECT_EQ(places[t].toes, expected.toes);
      }
    }
  }
}

TEST(FootGoals, AddTheDisplacementAndCarryTheHolds) {
  const HeavyBody body = heavy_body(0);
  testing::Dice dice(7);
  Motion motion{body.skeleton, {60.0}, 0, {}};
  for (int t = 0; t < 3; ++t) {
    motion.poses.push_back(testing::random_pose(body.skeleton, dice));
  }
  const std::vector<glm::dvec3> displaced{{0, 0, 0}, {0.1, 0, 0}, {0, 0.2, 0.3}};
  const std::vector<double> hold{0.0, 0.5, 1.0};
  const auto places = foot_places(motion, body.map, 1);
  const auto goals = foot_goals(motion, body.map, 1, {displaced, hold, {}});
  for (std::size_t t = 0; t < 3; ++t) {
    EXPECT_EQ(goals[t].place.ankle_in_world, places[t].ankle_in_world + displaced[t]);
    EXPECT_EQ(goals[t].place.foot, places[t].foot);
    EXPECT_EQ(goals[t].hold, hold[t]);
    EXPECT_EQ(goals[t].heel_may_rise, 0.0);
  }
  const auto free = foot_goals(motion, body.map, 1, {});
  EXPECT_EQ(free[2].hold, 0.0);
}

}  // namespace
}  // namespace marey::retarget
