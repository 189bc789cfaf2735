// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/motion/bvh.h"

#include <sstream>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "recordings/body/mannequin.h"
#include "tests/recordings/wild_motion.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

// Six decimals of a degree move the far end of a 2 m chain by 0.00002 mm each.
constexpr double kRounding_m = 1e-6;

Skeleton uneven_body() {
  return make_humanoid(uneven(average_proportions(1.75)));
}

Motion through_text(const Motion& motion, const BvhWriteOptions& options = {}) {
  const auto read =
      parse_bvh(bvh_text(motion, options), "text.bvh", {.unit_m = options.unit_m});
  EXPECT_TRUE(read) << read.error().message();
  return read ? read->motion : Motion{};
}

TEST(Bvh, KeepsEveryJointInItsPlaceThroughAFile) {
  const ScratchFolder folder;
  const Motion motion = wild_motion(uneven_body(), 40);
  ASSERT_TRUE(write_bvh(folder / "wild.bvh", motion));
  const auto read = read_bvh(folder / "wild.bvh");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_LT(largest_distance_m(motion, read->motion), kRounding_m);
}

TEST(Bvh, KeepsEveryJointInItsPlaceInTheOtherRotationOrder) {
  const Motion motion = wild_motion(uneven_body(), 40);
  const Motion read = through_text(motion, {.order = BvhOrder::kZyx});
  EXPECT_LT(largest_distance_m(motion, read), kRounding_m);
}

TEST(Bvh, KeepsEveryJointInItsPlaceInEveryOrder) {
  const Motion motion = wild_motion(uneven_body(), 20);
  for (const BvhOrder order : {BvhOrder::kXyz,
                               BvhOrder::kXzy,
                               BvhOrder::kYxz,
                               BvhOrder::kYzx,
                               BvhOrder::kZxy,
                               BvhOrder::kZyx}) {
    EXPECT_LT(largest_distance_m(motion, through_text(motion, {.order = order})),
              kRounding_m)
        << static_cast<int>(order);
  }
}

// Except names, which only BvhNames::kOwn keeps.
TEST(Bvh, KeepsEveryJointInItsPlaceInEveryDialect) {
  for (const BvhDialect dialect :
       {BvhDialect::kBlender, BvhDialect::kMobu, BvhDialect::kMaya, BvhDialect::kUnity}) {
    EXPECT_EQ(bvh_dialect(name(dialect)), dialect);
    Motion motion = wild_motion(with_turned_axes(uneven_body()), 20);
    const Motion read = through_text(motion, write_options(dialect));
    ASSERT_EQ(read.skeleton.joints.size(), motion.skeleton.joints.size());
    // A humanoid's joints are in the file's order.
    for (std::size_t i = 0; i < read.skeleton.joints.size(); ++i) {
      motion.skeleton.joints[i].name = read.skeleton.joints[i].name;
    }
    EXPECT_LT(largest_distance_m(motion, read), 1e-5) << name(dialect);
  }
  EXPECT_EQ(bvh_dialect("poser"), std::nullopt);
}

TEST(Bvh, NamesHumanBonesAsTheReaderWants) {
  Motion motion = wild_motion(uneven_body(), 1);
  motion.skeleton.joints[1].name = "my spine";
  motion.skeleton.joints[2].bone.reset();
  motion.skeleton.joints[2].name = "rig:Spine";
  motion.skeleton.joints[3].bone.reset();
  motion.skeleton.joints[3].name = "Spine";
  const auto names = [&](const BvhWriteOptions& options) {
    std::vector<std::string> list;
    const Skeleton read = through_text(motion, options).skeleton;
    for (std::size_t i = 0; i < 4; ++i) list.push_back(read.joints[i].name);
    list.push_back(read.joints[14].name);
    return list;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names({}), (Names{"hips", "my_spine", "rig:Spine", "Spine", "leftUpperLeg"}));
  EXPECT_EQ(names(write_options(BvhDialect::kMaya)),
            (Names{"Hips", "Spine", "rig_Spine", "Spine_2", "LeftUpLeg"}));
  EXPECT_EQ(names(write_options(BvhDialect::kUnity)),
            (Names{"Hips", "Spine", "rig:Spine", "Spine_2", "LeftUpperLeg"}));
}

TEST(Bvh, KeepsEveryJointInItsPlaceInMetres) {
  const Motion motion = wild_motion(uneven_body(), 40);
  // A metre with six decimals is a hundred times coarser than a centimetre with six.
  EXPECT_LT(largest_distance_m(motion, through_text(motion, {.unit_m = 1.0})), 1e-5);
}

TEST(Bvh, KeepsEveryJointOfASkeletonThatRestsTurned) {
  const Motion motion = wild_motion(with_turned_axes(uneven_body()), 40);
  EXPECT_LT(largest_distance_m(motion, through_text(motion)), kRounding_m);
}

TEST(Bvh, KeepsJointsWhereTheMiddleAngleIsRight) {
  Motion motion = wild_motion(uneven_body(), 9);
  const double right = std::acos(0.0);
  for (std::size_t frame = 1; frame < motion.poses.size(); ++frame) {
    const double turn = 0.3 * static_cast<double>(frame);
    for (glm::dquat& q : motion.poses[frame].parent_from_joint) {
      q = rotation_from_vector({0, 0, turn}) *
          rotation_from_vector({frame % 2 == 0 ? right : -right, 0, 0});
    }
  }
  EXPECT_LT(largest_distance_m(motion, through_text(motion)), kRounding_m);
}

TEST(Bvh, KeepsTheProportions) {
  const Skeleton body = uneven_body();
  const Skeleton read = through_text(wild_motion(body, 1)).skeleton;
  const Proportions before = proportions_of(body);
  const Proportions after = proportions_of(read);
  for (const HumanBone bone : human_bones()) {
    if (bone == HumanBone::kHips) continue;  // Its height is not in the file.
    EXPECT_LT(glm::distance(before[bone], after[bone]), 1e-8) << name(bone);
  }
  EXPECT_LT(glm::distance(before.left_hand_tip_in_hand, after.left_hand_tip_in_hand),
            1e-8);
}

TEST(Bvh, WritesTheRootWithoutAnOffset) {
  const std::string text = bvh_text(wild_motion(uneven_body(), 2));
  EXPECT_TRUE(text.starts_with(
      "HIERARCHY\nROOT hips\n{\n\tOFFSET 0.000000 0.000000 0.000000\n\tCHANNELS 6 "
      "Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"));
}

TEST(Bvh, WritesASpinWithoutJumpsOfTheAngles) {
  Motion motion = wild_motion(uneven_body(), 1);
  for (int frame = 1; frame < 60; ++frame) {
    motion.poses.push_back(motion.poses.front());
    motion.poses.back().parent_from_joint[0] =
        rotation_from_vector({0.4, 0, 0}) * rotation_from_vector({0, 0.2 * frame, 0});
  }
  std::istringstream text(bvh_text(motion));
  std::string line;
  while (std::getline(text, line) && !line.starts_with("Frame Time")) continue;
  std::getline(text, line);  // The rest pose may be far from the first turned one.
  double last_deg = 0.0;
  double largest_step_deg = 0.0;
  for (int frame = 1; std::getline(text, line); ++frame) {
    std::istringstream values(line);
    double value = 0.0;
    for (int i = 0; i < 6; ++i) values >> value;
    if (frame > 1)
      largest_step_deg = std::max(largest_step_deg, std::abs(value - last_deg));
    last_deg = value;
  }
  EXPECT_LT(largest_step_deg, 30.0);
  EXPECT_GT(std::abs(last_deg), 360.0);
}

TEST(Bvh, WritesTheSameBytesAgain) {
  const Motion motion = wild_motion(uneven_body(), 5);
  EXPECT_EQ(bvh_text(motion), bvh_text(motion));
}

TEST(Bvh, KeepsTheRate) {
  for (const double hz : {23.976,
                          24.0,
                          24000.0 / 1001.0,
                          29.97,
                          30000.0 / 1001.0,
                          30.0,
                          60000.0 / 1001.0,
                          60.0,
                          119.88,
                          120.0,
                          240.0}) {
    Motion motion = wild_motion(uneven_body(), 2);
    motion.rate.hz = hz;
    EXPECT_EQ(through_text(motion).rate.hz, hz);
  }
}

}  // namespace
}  // namespace marey::recordings
