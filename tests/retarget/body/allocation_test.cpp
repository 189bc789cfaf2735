// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <gtest/gtest.h>

#include "retarget/body/normalized_skeleton.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/count_allocations.h"

namespace marey::retarget {
namespace {

// Tests the calls of a live frame, forward kinematics included.
TEST(Normalize, AllocatesNothingPerFrame) {
  testing::Dice dice(1);
  const Skeleton source = testing::random_humanoid(dice);
  const Skeleton avatar = testing::with_vertebrae(testing::giant(), 7);
  const BodyMap from = *map_body(source);
  const BodyMap to = *map_body(avatar);
  const Pose pose = testing::random_pose(source, dice);
  std::vector<RigidTransform> source_frames(source.joints.size());
  std::vector<RigidTransform> avatar_frames(avatar.joints.size());
  NormalizedPose posture;
  Pose out = rest_pose(avatar);

  const long before = testing::allocations();
  for (int k = 0; k < 100; ++k) {
    world_from_joints(source, pose, source_frames);
    normalize(from, source_frames, posture);
    expand(posture, avatar, to, avatar_frames, out);
  }
  EXPECT_EQ(testing::allocations() - before, 0);
}

TEST(Normalize, WouldHaveItsAllocationsCounted) {
  const long before = testing::allocations();
  const auto* memory = new std::vector<double>(100);
  EXPECT_GT(testing::allocations() - before, 0);
  delete memory;
}

}  // namespace
}  // namespace marey::retarget
