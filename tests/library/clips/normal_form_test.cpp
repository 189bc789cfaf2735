// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/clips/normal_form.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/bodies/random_bodies.h"

namespace marey::library {
namespace {

using testing::Dice;

/// Largest distance of a joint between two motions of the same joints. [m]
double worst_distance_m(const Motion& a, const Motion& b) {
  double worst = 0.0;
  std::vector<RigidTransform> of_a(a.skeleton.joints.size());
  std::vector<RigidTransform> of_b(b.skeleton.joints.size());
  for (std::size_t f = 0; f < a.poses.size(); ++f) {
    world_from_joints(a.skeleton, a.poses[f], of_a);
    world_from_joints(b.skeleton, b.poses[f], of_b);
    for (std::size_t j = 0; j < of_a.size(); ++j) {
      worst = std::max(worst, glm::distance(of_a[j].translation, of_b[j].translation));
    }
  }
  return worst;
}

Motion random_motion(const Skeleton& skeleton, Dice& dice, int frames) {
  Motion motion;
  motion.skeleton = skeleton;
  motion.rate = FrameRate{30.0};
  motion.first_frame = 7;
  for (int f = 0; f < frames; ++f) {
    motion.poses.push_back(testing::random_pose(skeleton, dice));
  }
  return motion;
}

TEST(NormalForm, KeepsEveryJointInItsPlaceOnAnyBody) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Dice dice(seed);
    Skeleton body = testing::random_humanoid(dice);
    if (seed % 2 == 0) body = testing::with_extra_joints(body);
    if (seed % 3 == 0) body = testing::in_a_pose(body, dice.between(0.0, 0.9));
    if (seed % 5 != 0) body = testing::with_random_axes(body, dice);
    const Motion motion = random_motion(body, dice, 5);
    const auto map = retarget::map_body(body);
    ASSERT_TRUE(map) << map.error().message();
    const Motion normal = in_normal_form(motion, *map);
    EXPECT_LT(worst_distance_m(motion, normal), 1e-9) << "seed " << seed;
    EXPECT_EQ(normal.first_frame, 7);
    for (const Joint& joint : normal.skeleton.joints) {
      EXPECT_NEAR(std::abs(joint.parent_from_joint.rotation.w), 1.0, 1e-12);
    }
  }
}

TEST(NormalForm, RestsInTheCanonicalTPose) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Dice dice(seed);
    const Skeleton body = testing::with_random_axes(
        testing::in_a_pose(testing::random_humanoid(dice), 0.7), dice);
    const auto map = retarget::map_body(body);
    ASSERT_TRUE(map);
    const Motion normal = in_normal_form(random_motion(body, dice, 1), *map);
    const auto elbow = *normal.skeleton.find(HumanBone::kLeftLowerArm);
    const auto knee = *normal.skeleton.find(HumanBone::kRightLowerLeg);
    const glm::dvec3 arm =
        glm::normalize(normal.skeleton[elbow].parent_from_joint.translation);
    const glm::dvec3 leg =
        glm::normalize(normal.skeleton[knee].parent_from_joint.translation);
    EXPECT_NEAR(arm.x, 1.0, 1e-9);
    EXPECT_NEAR(leg.y, -1.0, 1e-9);
  }
}

TEST(NormalForm, TwiceIsTheSameAsOnce) {
  Dice dice(3);
  const Skeleton body = testing::with_random_axes(testing::child(), dice);
  const auto once = make_library_motion(random_motion(body, dice, 4));
  ASSERT_TRUE(once) << once.error().message();
  const auto twice = make_library_motion(once->motion);
  ASSERT_TRUE(twice) << twice.error().message();
  for (std::size_t f = 0; f < once->motion.poses.size(); ++f) {
    for (std::size_t j = 0; j < body.joints.size(); ++j) {
      EXPECT_NEAR(std::abs(glm::dot(once->motion.poses[f].parent_from_joint[j],
                                    twice->motion.poses[f].parent_from_joint[j])),
                  1.0,
                  1e-9);
    }
  }
}

TEST(NormalForm, RefusesAMotionWithoutFramesOrLegs) {
  Dice dice(1);
  EXPECT_FALSE(make_library_motion(random_motion(testing::child(), dice, 0)));
  Motion stick = random_motion(testing::child(), dice, 1);
  for (Joint& joint : stick.skeleton.joints) joint.bone.reset();
  const auto refused = make_library_motion(stick);
  ASSERT_FALSE(refused);
  EXPECT_FALSE(refused.error().message().empty());
}

TEST(NormalForm, APartHasTheFramesThatItNames) {
  Dice dice(2);
  const auto whole = make_library_motion(random_motion(testing::giant(), dice, 9));
  ASSERT_TRUE(whole);
  const LibraryMotion part = part_of(*whole, 2, 5);
  ASSERT_EQ(part.motion.poses.size(), 4u);
  EXPECT_EQ(part.motion.first_frame, 9);
  EXPECT_EQ(part.contacts.size(), 4u);
  EXPECT_EQ(part.motion.poses[0].root_in_world, whole->motion.poses[2].root_in_world);
}

}  // namespace
}  // namespace marey::library
