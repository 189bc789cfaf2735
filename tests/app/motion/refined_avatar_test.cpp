// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Arms and hands in the motions of marey process and marey fit, on bodies whose width is
// measured from the skin.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "app/motion/read_body.h"
#include "app/motion/retarget_files.h"
#include "core/human/average_proportions.h"
#include "core/pose.h"
#include "recordings/body/mannequin.h"
#include "recordings/gltf/gltf.h"
#include "retarget/body/body_map.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

using B = HumanBone;
using P = retarget::VolumePart;

std::filesystem::path mannequin(const testing::ScratchFolder& folder, double girth) {
  const Proportions proportions = recordings::mannequin_proportions({});
  const auto path = folder / ("girth" + std::to_string(girth) + ".glb");
  EXPECT_TRUE(recordings::write_character(
      path,
      make_humanoid(proportions),
      recordings::make_mannequin_mesh(proportions, {.girth = girth})));
  return path;
}

// Returns a motion whose arms hang down and swing past the trunk and in front of it.
Motion swinging_arms() {
  Motion motion{make_humanoid(average_proportions(1.75)), {60.0}, 0, {}};
  const auto arm = [&](B bone) { return index(*motion.skeleton.find(bone)); };
  for (int t = 0; t < 120; ++t) {
    Pose pose = rest_pose(motion.skeleton);
    const double swing = 0.5 * std::sin(0.1 * t);
    const glm::dquat pitch = glm::angleAxis(swing, glm::dvec3(1, 0, 0));
    const glm::dquat bend = glm::angleAxis(-0.7, glm::dvec3(0, 1, 0));
    pose.parent_from_joint[arm(B::kLeftUpperArm)] =
        pitch * glm::angleAxis(-1.45, glm::dvec3(0, 0, 1));
    pose.parent_from_joint[arm(B::kRightUpperArm)] =
        pitch * glm::angleAxis(1.45, glm::dvec3(0, 0, 1));
    pose.parent_from_joint[arm(B::kLeftLowerArm)] = bend;
    pose.parent_from_joint[arm(B::kRightLowerArm)] = glm::conjugate(bend);
    motion.poses.push_back(std::move(pose));
  }
  return motion;
}

// Returns the largest depth of elbows and wrists in trunk and thighs, from the skin
// alone. Upper arms are left out: on a wide body they begin within the chest. [m]
double max_depth_m(const Motion& motion, const retarget::BodyVolume& volume) {
  double deepest = 0.0;
  for (const Pose& pose : motion.poses) {
    const auto world = world_from_joints(motion.skeleton, pose);
    for (const B bone :
         {B::kLeftLowerArm, B::kRightLowerArm, B::kLeftHand, B::kRightHand}) {
      const glm::dvec3 p = world[index(*motion.skeleton.find(bone))].translation;
      for (const P part : {P::kChest, P::kAbdomen, P::kPelvis, P::kLeftThigh}) {
        deepest = std::max(deepest, -side_of(*volume[part], world, p).distance_m);
      }
    }
  }
  return deepest;
}

TEST(RefinedAvatar, KeepsArmsOutOfTheBellyThatItsSkinHas) {
  const testing::ScratchFolder folder;
  const Motion motion = swinging_arms();
  for (const double girth : {1.0, 2.4}) {
    const auto avatar = mannequin(folder, girth);
    const auto body = read_body(avatar);
    ASSERT_TRUE(body);
    ASSERT_TRUE(body->volume);
    const auto made = retarget_to_files(motion, avatar, folder / "out");
    ASSERT_TRUE(made) << made.error().message();
    const auto bare = retarget::retarget_motion(motion, body->skeleton());
    ASSERT_TRUE(bare);
    // Joints lie within arms: on the skin's surface their arm's radius is outside.
    const double before_m = max_depth_m(bare->motion, *body->volume);
    const double after_m = max_depth_m(made->retargeted.motion, *body->volume);
    if (girth > 2.0) {
      EXPECT_GT(before_m, 0.03) << "the claim is empty";
    }
    EXPECT_LE(after_m, 0.0) << girth;
  }
}

// The radii follow the girth of the mannequin: a wide one does not get average radii.
TEST(RefinedAvatar, IsAsWideAsItsSkin) {
  const testing::ScratchFolder folder;
  const auto lean = read_body(mannequin(folder, 1.0));
  const auto fat = read_body(mannequin(folder, 2.0));
  ASSERT_TRUE(lean && fat);
  for (const P part :
       {P::kChest, P::kAbdomen, P::kPelvis, P::kLeftThigh, P::kRightForearm}) {
    const double wider = (*fat->volume)[part]->radius_m / (*lean->volume)[part]->radius_m;
    EXPECT_NEAR(wider, 2.0, 0.2) << name(part);
  }
}

}  // namespace
}  // namespace marey::app
