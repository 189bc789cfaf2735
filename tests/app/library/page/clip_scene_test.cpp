// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/page/clip_scene.h"

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "app/library/page/clip_drawing.h"
#include "app/library/page/clip_neighbours.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::app {
namespace {

/// Returns the motion with a joint above the hips that stays at the origin, turned to +X
/// and 3 m away from it.
Motion below_a_fixed_root(const Motion& walk) {
  Motion out{{}, walk.rate, 0, {}};
  Joint root;
  root.name = "Root";
  out.skeleton.joints.push_back(root);
  for (Joint joint : walk.skeleton.joints) {
    joint.parent = joint.parent ? JointIndex{static_cast<int>(index(*joint.parent)) + 1}
                                : JointIndex{0};
    out.skeleton.joints.push_back(joint);
  }
  // The root's rotation moves the hips about it.
  const glm::dquat turn =
      glm::angleAxis(0.5 * std::numbers::pi, glm::dvec3(0.0, 1.0, 0.0));
  for (const Pose& pose : walk.poses) {
    Pose moved;
    moved.root_in_world = {3.0, 0.0, 0.0};
    moved.parent_from_joint.push_back(turn);
    for (const glm::dquat& one : pose.parent_from_joint) {
      moved.parent_from_joint.push_back(one);
    }
    out.poses.push_back(std::move(moved));
  }
  return out;
}

/// Returns the position of the root of the first skeleton in the first frame of a block.
std::array<float, 3> first_root(const PageOfRecording& page) {
  constexpr std::size_t kPlace = 16 + 24 + 4;  // Heads of block, frame and skeleton.
  std::array<float, 3> out{};
  std::memcpy(out.data(), page.media.front().bytes->data() + kPlace, sizeof out);
  return out;
}

TEST(ClipScene, StartsWithTheHipsAtTheOrigin) {
  const Motion clip = below_a_fixed_root(testing::synthetic_walk(60, 30.0).motion);
  const auto scene = make_clip_scene("walk", clip, 0.0, {}, 1);
  ASSERT_TRUE(scene) << scene.error().message();
  const auto& skeleton = scene->page.scene.skeletons.front().skeleton;
  EXPECT_EQ(skeleton.joints.front().bone, HumanBone::kHips);
  EXPECT_FALSE(skeleton.joints.front().parent);
  const auto root = first_root(scene->page);
  EXPECT_NEAR(root[0], 0.0, 1e-5);
  EXPECT_NEAR(root[2], 0.0, 1e-5);
  EXPECT_GT(root[1], 0.5);
}

TEST(ClipScene, PlaysAPartAsFastAsTheClip) {
  const Motion clip = testing::synthetic_walk(61, 30.0).motion;
  // 1 s of the other motion corresponds to the 2 s of the clip.
  const ComparedMotion other{
      "other", testing::synthetic_walk(121, 60.0).motion, 0.5, 1.5};
  const auto scene = make_clip_scene("walk", clip, 2.0, std::array{other}, 5);
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->page.scene.skeletons.size(), 2U);
  EXPECT_EQ(scene->page.scene.file->frames, 61);
  EXPECT_EQ(scene->page.scene.rate_hz, 30.0);
  EXPECT_EQ(scene->page.media.front().path, "/media/5");
}

TEST(ClipScene, ShowsLongClipsWithFewerFrames) {
  Motion clip = testing::synthetic_walk(60, 120.0).motion;
  const Pose pose = clip.poses.front();
  clip.poses.assign(2 * kMaxSceneFrames + 1, pose);
  const auto scene = make_clip_scene("long", clip, 0.0, {}, 1);
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->frame_step, 3);
  EXPECT_EQ(scene->page.scene.rate_hz, 40.0);
  EXPECT_LE(scene->page.scene.file->frames, static_cast<int>(kMaxSceneFrames));
}

TEST(ClipDrawing, IsTheSameFromEverySide) {
  const Motion walk = testing::synthetic_walk(60, 30.0).motion;
  const ClipDrawing straight = draw_clip(walk);
  const ClipDrawing turned = draw_clip(below_a_fixed_root(walk));
  // The turned one has the hips at their height at rest.
  const auto hips = index(HumanBone::kHips);
  const auto hand = index(HumanBone::kLeftHand);
  EXPECT_EQ(straight.poses[0][hips].x, 0);
  EXPECT_NEAR(straight.poses[0][hand].x, turned.poses[0][hand].x, 2);
}

TEST(FirstRow, IsAtTheNextTenthOfASecond) {
  EXPECT_NEAR(first_row_s(0, 30.0), 0.0, 1e-12);
  EXPECT_NEAR(first_row_s(3, 30.0), 0.0, 1e-9);
  EXPECT_NEAR(first_row_s(4, 30.0), 0.2 - 4.0 / 30.0, 1e-9);
  EXPECT_NEAR(first_row_s(7, 120.0), 0.1 - 7.0 / 120.0, 1e-9);
}

}  // namespace
}  // namespace marey::app
