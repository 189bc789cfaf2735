// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/pose.h"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/smooth_step.h"
#include "tests/edit/ops/op_scene.h"
#include "tests/edit/ops/standing_scene.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::edit {
namespace {

constexpr int kPoseFrames = 120;
constexpr int kAt = 60;
constexpr double kRounding_m = 1e-12;

OpScene<PoseOp> pose_key(HumanBone bone, const glm::dvec3& moved_m, int at = kAt) {
  PoseOp op;
  op.at = AtFrame{static_cast<double>(at)};
  op.bone = bone;
  op.moved_m = moved_m;
  op.width_s = 0.5;  // 30 frames.
  return OpScene<PoseOp>(op);
}

EditState posed(OpScene<PoseOp> scene, const EditState& state) {
  auto out = scene.run(apply_pose, state);
  EXPECT_TRUE(out) << (out ? "" : out.error().message());
  return *std::move(out);
}

TEST(PoseOp, AKeyMovesTheHandExactlyToItsPlaceAndFadesAroundIt) {
  const EditState state = state_of(standing_motion(kPoseFrames));
  const glm::dvec3 moved_m(0.1, 0.2, 0.15);
  OpScene<PoseOp> scene = pose_key(HumanBone::kLeftHand, moved_m);
  const EditState out = posed(scene, state);
  const auto was = joint_way(state.motion, HumanBone::kLeftHand);
  const auto is = joint_way(out.motion, HumanBone::kLeftHand);
  for (int t = 0; t < kPoseFrames; ++t) {
    const auto i = static_cast<std::size_t>(t);
    const double share = smooth_step(1.0 - std::abs(t - kAt) / 30.0);
    EXPECT_LT(glm::distance(is[i], was[i] + share * moved_m), kRounding_m) << t;
  }
}

TEST(PoseOp, FramesOutsideTheWidthStayToTheBit) {
  const EditState state = state_of(testing::synthetic_walk(kPoseFrames, 60.0).motion);
  for (const HumanBone bone :
       {HumanBone::kRightHand, HumanBone::kLeftFoot, HumanBone::kHips}) {
    const EditState out = posed(pose_key(bone, {0.03, -0.04, 0.02}), state);
    for (int t = 0; t < kPoseFrames; ++t) {
      const auto i = static_cast<std::size_t>(t);
      const bool is_outside = std::abs(t - kAt) >= 30;
      EXPECT_EQ(same_pose(out.motion.poses[i], state.motion.poses[i]), is_outside) << t;
      EXPECT_EQ(ops_of(out.lineage, t).empty(), is_outside) << t;
    }
  }
}

TEST(PoseOp, FeetStayWhileTheHipsMove) {
  const EditState state = state_of(testing::synthetic_walk(kPoseFrames, 60.0).motion);
  const EditState out = posed(pose_key(HumanBone::kHips, {0.02, -0.08, 0.0}), state);
  for (const HumanBone foot : {HumanBone::kLeftFoot, HumanBone::kRightFoot}) {
    const auto was = joint_way(state.motion, foot);
    const auto is = joint_way(out.motion, foot);
    for (std::size_t t = 0; t < was.size(); ++t) {
      EXPECT_LT(glm::distance(is[t], was[t]), 1e-9) << t;
    }
  }
  const auto hips = joint_way(out.motion, HumanBone::kHips);
  const auto hips_were = joint_way(state.motion, HumanBone::kHips);
  EXPECT_NEAR(hips[kAt].y - hips_were[kAt].y, -0.08, kRounding_m);
}

TEST(PoseOp, ARaiseThatTheLegsDoNotReachIsLoweredAndReported) {
  const EditState state = state_of(standing_motion(kPoseFrames));
  OpScene<PoseOp> scene = pose_key(HumanBone::kHips, {0.0, 0.2, 0.0});
  const auto out = scene.run(apply_pose, state);
  ASSERT_TRUE(out);
  EXPECT_TRUE(scene.has_finding("reach"));
  EXPECT_GT(scene.figure("lowered_mm"), 100.0);
  const auto was = joint_way(state.motion, HumanBone::kLeftFoot);
  const auto is = joint_way(out->motion, HumanBone::kLeftFoot);
  for (std::size_t t = 0; t < was.size(); ++t) {
    EXPECT_LT(glm::distance(is[t], was[t]), 1e-9);
  }
}

TEST(PoseOp, ATargetBeyondTheArmIsReachedByTheWholeBody) {
  const EditState state = state_of(standing_motion(kPoseFrames));
  OpScene<PoseOp> scene = pose_key(HumanBone::kLeftHand, {0.2, 0.1, 0.7});
  const auto out = scene.run(apply_pose, state);
  ASSERT_TRUE(out) << out.error().message();
  const auto was = joint_way(state.motion, HumanBone::kLeftHand);
  const auto is = joint_way(out->motion, HumanBone::kLeftHand);
  const glm::dvec3 target = was[kAt] + glm::dvec3(0.2, 0.1, 0.7);
  EXPECT_LT(glm::distance(is[kAt], target), 1e-3);
  const auto foot = joint_way(out->motion, HumanBone::kLeftFoot);
  EXPECT_LT(glm::distance(foot[kAt], foot[0]), 1e-3);
  // The way stays smooth where the arm alone no longer suffices.
  double largest_m_per_s2 = 0.0;
  for (std::size_t t = 1; t + 1 < is.size(); ++t) {
    const glm::dvec3 bend = is[t + 1] - 2.0 * is[t] + is[t - 1];
    largest_m_per_s2 = std::max(largest_m_per_s2, glm::length(bend) * 3600.0);
  }
  // A fade of 0.74 m in 0.5 s has a peak of 5.8 s / T^2 = 17 m/s^2.
  EXPECT_LT(largest_m_per_s2, 20.0);
}

TEST(PoseOp, ATargetBeyondTheBodyIsReportedWithItsDistance) {
  const EditState state = state_of(standing_motion(kPoseFrames));
  OpScene<PoseOp> scene = pose_key(HumanBone::kLeftHand, {0.0, 0.0, 4.0});
  ASSERT_TRUE(scene.run(apply_pose, state));
  EXPECT_TRUE(scene.has_finding("reach"));
  EXPECT_GT(scene.figure("missed_mm"), 1000.0);
}

TEST(PoseOp, KeysOneWidthApartAreASplineThroughTheKeys) {
  const EditState state = state_of(standing_motion(kPoseFrames));
  const glm::dvec3 first(0.1, 0.1, 0.1);
  const glm::dvec3 second(0.0, 0.15, 0.2);
  const EditState out = posed(pose_key(HumanBone::kRightHand, second, 70),
                              posed(pose_key(HumanBone::kRightHand, first, 40), state));
  const auto was = joint_way(state.motion, HumanBone::kRightHand);
  const auto is = joint_way(out.motion, HumanBone::kRightHand);
  for (std::size_t t = 40; t <= 70; ++t) {
    const double share = smooth_step((static_cast<double>(t) - 40.0) / 30.0);
    const glm::dvec3 moved = first + share * (second - first);
    EXPECT_LT(glm::distance(is[t], was[t] + moved), 1e-9) << t;
  }
}

TEST(PoseOp, DisjointKeysCommuteToTheBit) {
  const EditState state = state_of(testing::synthetic_walk(kPoseFrames, 60.0).motion);
  const auto a = pose_key(HumanBone::kLeftHand, {0.1, 0.0, 0.0}, 30);
  const auto b = pose_key(HumanBone::kHips, {0.0, -0.05, 0.0}, 90);
  const EditState ab = posed(b, posed(a, state));
  const EditState ba = posed(a, posed(b, state));
  for (std::size_t t = 0; t < ab.motion.poses.size(); ++t) {
    EXPECT_TRUE(same_pose(ab.motion.poses[t], ba.motion.poses[t])) << t;
  }
}

TEST(PoseOp, ARotationIsAddedInTheFrameOfTheParent) {
  const EditState state = state_of(standing_motion(kPoseFrames));
  PoseOp op;
  op.at = AtTime{1.0};
  op.bone = HumanBone::kHead;
  op.rotation = glm::angleAxis(0.5, glm::dvec3(0, 1, 0));
  OpScene<PoseOp> scene(op);
  const auto out = scene.run(apply_pose, state);
  ASSERT_TRUE(out);
  const std::size_t head = index(*state.motion.skeleton.find(HumanBone::kHead));
  const glm::dquat expected =
      *op.rotation * state.motion.poses[kAt].parent_from_joint[head];
  EXPECT_NEAR(
      std::abs(glm::dot(out->motion.poses[kAt].parent_from_joint[head], expected)),
      1.0,
      1e-14);
}

TEST(PoseOp, BadKeysAreRefusedWithTheirName) {
  const EditState state = state_of(standing_motion(kPoseFrames));
  const auto refusal = [&](OpScene<PoseOp> scene) {
    const auto out = scene.run(apply_pose, state);
    EXPECT_FALSE(out);
    return out ? std::string() : out.error().message();
  };
  EXPECT_NE(refusal(pose_key(HumanBone::kHead, {0, 0.1, 0})).find("moved_m"),
            std::string::npos);
  EXPECT_NE(refusal(pose_key(HumanBone::kHips, {0, std::nan(""), 0})).find("moved_m"),
            std::string::npos);
  OpScene<PoseOp> wide = pose_key(HumanBone::kHips, {0, 0.1, 0});
  std::get<PoseOp>(wide.op.parameters).width_s = 0.0;
  EXPECT_NE(refusal(wide).find("width_s"), std::string::npos);
  OpScene<PoseOp> late = pose_key(HumanBone::kHips, {0, 0.1, 0}, 500);
  EXPECT_FALSE(refusal(late).empty());
  OpScene<PoseOp> empty{PoseOp{}};
  EXPECT_NE(refusal(empty).find("no displacement"), std::string::npos);
  OpScene<PoseOp> grouped = pose_key(HumanBone::kHips, {0, 0.1, 0});
  grouped.op.groups = {EditGroup::kTrunk};
  EXPECT_NE(refusal(grouped).find("groups"), std::string::npos);
}

}  // namespace
}  // namespace marey::edit
