// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "library/export/named_skeleton.h"

#include <set>
#include <string>

#include "library/export/start_at_origin.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "tests/library/moved_motion.h"

namespace marey::library {
namespace {

TEST(NamedSkeleton, HasTheBonesOfAnAverageAdult) {
  const Skeleton humanoid = make_humanoid(average_proportions(1.75));
  const auto places = world_from_joints(humanoid, rest_pose(humanoid));
  for (const NamedSkeleton kind :
       {NamedSkeleton::kMarey, NamedSkeleton::kSmpl22, NamedSkeleton::kLafan22}) {
    EXPECT_EQ(named_skeleton(name(kind)), kind);
    const Skeleton skeleton = make_named_skeleton(kind);
    ASSERT_EQ(skeleton.joints.size(), 22u);
    const auto own = world_from_joints(skeleton, rest_pose(skeleton));
    std::set<std::string> names;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
      const Joint& joint = skeleton.joints[j];
      names.insert(joint.name);
      ASSERT_TRUE(joint.bone);
      EXPECT_EQ(joint.parent.has_value(), j > 0);
      if (joint.parent) {
        EXPECT_LT(index(*joint.parent), j) << joint.name;
      }
      EXPECT_LT(glm::distance(own[j].translation, places[index(*joint.bone)].translation),
                1e-12);
    }
    EXPECT_EQ(names.size(), 22u);
  }
  EXPECT_EQ(named_skeleton("humanoid"), NamedSkeleton::kMarey);
  EXPECT_FALSE(named_skeleton("own"));
}

TEST(NamedSkeleton, HasThePublishedOrder) {
  const Skeleton smpl = make_named_skeleton(NamedSkeleton::kSmpl22);
  EXPECT_EQ(smpl.joints[0].name, "pelvis");
  EXPECT_EQ(smpl.joints[15].name, "head");
  EXPECT_EQ(smpl.joints[21].name, "right_wrist");
  EXPECT_EQ(smpl.joints[13].parent, JointIndex{9}) << "the collar is below spine3";
  const Skeleton lafan = make_named_skeleton(NamedSkeleton::kLafan22);
  EXPECT_EQ(lafan.joints[4].name, "LeftToe");
  EXPECT_EQ(lafan.joints[21].name, "RightHand");
}

TEST(StartAtOrigin, TurnsTheFirstFrameForward) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Motion plain = random_motion(seed, 10, 30.0);
    const auto map = retarget::map_body(plain.skeleton);
    ASSERT_TRUE(map);
    Motion other = moved(plain, 0.3 * static_cast<double>(seed), 4.0, -7.0);
    start_at_origin(plain, *map);
    start_at_origin(other, *map);
    EXPECT_NEAR(plain.poses[0].root_in_world.x, 0.0, 1e-9);
    EXPECT_NEAR(plain.poses[0].root_in_world.z, 0.0, 1e-9);
    for (std::size_t f = 0; f < plain.poses.size(); ++f) {
      const auto a = world_from_joints(plain.skeleton, plain.poses[f]);
      const auto b = world_from_joints(other.skeleton, other.poses[f]);
      for (std::size_t j = 0; j < a.size(); ++j) {
        EXPECT_LT(glm::distance(a[j].translation, b[j].translation), 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace marey::library
