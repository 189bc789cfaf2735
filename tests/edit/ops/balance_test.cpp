// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/balance.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include "edit/balance/zmp_track.h"
#include "edit/ops/offset.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/centre_of_mass.h"
#include "retarget/balance/measure_balance.h"
#include "core/base/smooth_step.h"
#include "retarget/body/place_masses.h"
#include "tests/edit/ops/op_scene.h"
#include "tests/edit/ops/standing_scene.h"
#include "tests/support/simulation/synthetic_walk.h"
#include "tests/support/truth/zmp_judge.h"

namespace marey::edit {
namespace {

constexpr int kFrames = 300;

/// A standing adult whose hips and trunk go forward until the centre of mass is in front
/// of the toes, from frame 100 to 200. The feet stay.
Motion leaning() {
  const Motion upright = standing_motion(1);
  const auto map = retarget::map_body(upright.skeleton);
  const auto feet = world_from_joints(upright.skeleton, upright.poses[0]);
  return standing_motion(kFrames, [&](int frame, Pose& pose) {
    const double share = smooth_step((frame - 40) / 60.0) *
                         smooth_step((260 - frame) / 60.0);
    pose.parent_from_joint[static_cast<std::size_t>(HumanBone::kSpine)] =
        glm::angleAxis(0.5 * share, glm::dvec3(1, 0, 0));
    pose.root_in_world += share * glm::dvec3(0.0, -0.04, 0.15);
    LimbBender bender(upright.skeleton, *map);
    for (int side = 0; side < 2; ++side) {
      const RigidTransform& foot = feet[index(map->leg(side).end)];
      bender.move_end(2 + side, foot.translation, foot.rotation, pose);
    }
  });
}

/// Frames with support whose centre of mass is outside of the soles' hull by more than a
/// tolerance, by the independent measure of retarget/balance/measure_balance.h.
int frames_outside(const EditState& state, double tolerance_m = 0.0) {
  const auto masses = retarget::place_masses(state.motion.skeleton, state.map, {});
  EXPECT_TRUE(masses);
  int out = 0;
  for (const auto& outside_m :
       retarget::track_balance(state.motion, state.map, *masses, state.contacts)) {
    if (outside_m && *outside_m > tolerance_m) ++out;
  }
  return out;
}

TEST(BalanceOp, TheCentreOfMassComesBackOverTheFeet) {
  const EditState state = state_of(leaning());
  ASSERT_GT(frames_outside(state), 60);
  OpScene<BalanceOp> scene{BalanceOp{}};
  const auto out = scene.run(apply_balance, state);
  ASSERT_TRUE(out) << out.error().message();
  EXPECT_EQ(frames_outside(*out), 0);
  EXPECT_EQ(scene.figure("outside_frames"), 0.0);
  EXPECT_GT(scene.figure("max_shift_mm"), 20.0);
  for (const HumanBone foot : {HumanBone::kLeftFoot, HumanBone::kRightFoot}) {
    const auto was = joint_way(state.motion, foot);
    const auto is = joint_way(out->motion, foot);
    for (std::size_t t = 0; t < was.size(); ++t) {
      EXPECT_LT(glm::distance(is[t], was[t]), 1e-9) << t;
    }
  }
  // The trunk keeps its rotation in the hips.
  const std::size_t spine = index(*state.motion.skeleton.find(HumanBone::kSpine));
  EXPECT_EQ(out->motion.poses[150].parent_from_joint[spine],
            state.motion.poses[150].parent_from_joint[spine]);
}

TEST(BalanceOp, AStanceInBalanceStaysToTheBit) {
  const EditState state = state_of(standing_motion(120));
  OpScene<BalanceOp> scene{BalanceOp{}};
  const auto out = scene.run(apply_balance, state);
  ASSERT_TRUE(out);
  for (std::size_t t = 0; t < 120; ++t) {
    EXPECT_TRUE(same_pose(out->motion.poses[t], state.motion.poses[t])) << t;
  }
}

TEST(BalanceOp, FramesOutsideOfTheSpanStayToTheBit) {
  const EditState state = state_of(leaning());
  OpScene<BalanceOp> scene{BalanceOp{}};
  scene.op.span = {AtFrame{120}, AtFrame{180}};
  scene.op.blend_s = 0.3;
  const auto out = scene.run(apply_balance, state);
  ASSERT_TRUE(out);
  for (std::size_t t = 0; t < kFrames; ++t) {
    if (t > 102 && t < 198) continue;
    EXPECT_TRUE(same_pose(out->motion.poses[t], state.motion.poses[t])) << t;
  }
  EXPECT_FALSE(same_pose(out->motion.poses[150], state.motion.poses[150]));
}

TEST(BalanceOp, AWalkIsHardlyMoved) {
  const EditState state = state_of(testing::synthetic_walk(240, 60.0).motion);
  OpScene<BalanceOp> scene{BalanceOp{}};
  ASSERT_TRUE(scene.run(apply_balance, state));
  EXPECT_LT(scene.figure("max_shift_mm"), 10.0);
}

TEST(BalanceOp, GroupsAreRefused) {
  OpScene<BalanceOp> scene{BalanceOp{}};
  scene.op.groups = {EditGroup::kTrunk};
  const auto out = scene.run(apply_balance, state_of(standing_motion(60)));
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().where, "groups");
}

/// Loaded frames whose zero moment point is outside of the soles, by independent code.
int zmp_frames_outside(const EditState& state, const EditState& reference) {
  const auto masses = retarget::place_masses(state.motion.skeleton, state.map, {});
  EXPECT_TRUE(masses);
  const ZmpGround ground =
      zmp_ground(reference.motion, reference.map, reference.contacts);
  int out = 0;
  for (const testing::JudgedZmp& one : testing::judge_zmp(state.motion,
                                                          testing::judged_feet(state.map),
                                                          *masses,
                                                          ground.loaded,
                                                          ground.floor_height_m)) {
    if (one.vertical_force_g >= 0.2 && one.outside_m && *one.outside_m > 1e-6) ++out;
  }
  return out;
}

TEST(BalanceOp, TheZeroMomentPointOfALeanComesBackOverTheFeet) {
  const EditState state = state_of(leaning());
  ASSERT_GT(zmp_frames_outside(state, state), 60);
  OpScene<BalanceOp> scene{BalanceOp{EditBalance::kZmp}};
  const auto out = scene.run(apply_balance, state);
  ASSERT_TRUE(out) << out.error().message();
  EXPECT_EQ(zmp_frames_outside(*out, state), 0);
  EXPECT_EQ(scene.figure("zmp_outside_frames"), 0.0);
  EXPECT_GT(scene.figure("zmp_outside_before_frames"), 60.0);
  EXPECT_FALSE(scene.has_finding("zmp"));
  for (const HumanBone foot : {HumanBone::kLeftFoot, HumanBone::kRightFoot}) {
    const auto was = joint_way(state.motion, foot);
    const auto is = joint_way(out->motion, foot);
    for (std::size_t t = 0; t < was.size(); ++t) {
      EXPECT_LT(glm::distance(is[t], was[t]), 1e-6) << t;
    }
  }
}

TEST(BalanceOp, TheZeroMomentPointOfAWalkIsInside) {
  const EditState state = state_of(testing::synthetic_walk(240, 60.0).motion);
  ASSERT_GT(zmp_frames_outside(state, state), 0);
  OpScene<BalanceOp> scene{BalanceOp{EditBalance::kZmp}};
  const auto out = scene.run(apply_balance, state);
  ASSERT_TRUE(out);
  EXPECT_EQ(zmp_frames_outside(*out, state), 0);
}

TEST(BalanceOp, WithTheZeroMomentPointFramesOutsideOfTheSpanStayToTheBit) {
  const EditState state = state_of(leaning());
  OpScene<BalanceOp> scene{BalanceOp{EditBalance::kZmp}};
  scene.op.span = {AtFrame{120}, AtFrame{180}};
  scene.op.blend_s = 0.3;
  const auto out = scene.run(apply_balance, state);
  ASSERT_TRUE(out);
  for (std::size_t t = 0; t < kFrames; ++t) {
    if (t > 102 && t < 198) continue;
    EXPECT_TRUE(same_pose(out->motion.poses[t], state.motion.poses[t])) << t;
  }
  EXPECT_FALSE(same_pose(out->motion.poses[150], state.motion.poses[150]));
}

TEST(BalanceOp, AStanceWhoseZeroMomentPointIsInsideStaysToTheBit) {
  const EditState state = state_of(standing_motion(120));
  OpScene<BalanceOp> scene{BalanceOp{EditBalance::kZmp}};
  const auto out = scene.run(apply_balance, state);
  ASSERT_TRUE(out);
  for (std::size_t t = 0; t < 120; ++t) {
    EXPECT_TRUE(same_pose(out->motion.poses[t], state.motion.poses[t])) << t;
  }
}

}  // namespace
}  // namespace marey::edit
