// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/offset.h"

#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/edit/ops/op_scene.h"
#include "tests/edit/ops/standing_scene.h"

namespace marey::edit {
namespace {

constexpr int kOffsetFrames = 240;  // 4 s.

OpScene<OffsetOp> lowered_hips() {
  OffsetOp op;
  op.moved_m = glm::dvec3(0.0, -0.1, 0.0);
  OpScene<OffsetOp> scene(op);
  scene.op.span = {AtTime{1.5}, AtTime{2.5}};
  scene.op.blend_s = 1.0;
  return scene;
}

TEST(OffsetOp, IsConstantInItsSpanAndAbsentOutsideOfItsFades) {
  const EditState state = state_of(standing_motion(kOffsetFrames));
  OpScene<OffsetOp> scene = lowered_hips();
  const auto out = scene.run(apply_offset, state);
  ASSERT_TRUE(out) << out.error().message();
  for (std::size_t t = 0; t < kOffsetFrames; ++t) {
    const double moved =
        out->motion.poses[t].root_in_world.y - state.motion.poses[t].root_in_world.y;
    if (t >= 90 && t <= 150) {
      EXPECT_NEAR(moved, -0.1, 1e-14) << t;
    }
    if (t <= 30 || t >= 210) {
      EXPECT_TRUE(same_pose(out->motion.poses[t], state.motion.poses[t])) << t;
    }
  }
  const auto foot = joint_way(out->motion, HumanBone::kRightFoot);
  for (const glm::dvec3& p : foot) EXPECT_LT(glm::distance(p, foot[0]), 1e-9);
}

// The third difference of a C2 curve of fifth order is bounded by its third derivative
// times the cubed step; a jump of the acceleration would be about 60 times as large.
TEST(OffsetOp, FadesWithContinuousAcceleration) {
  const EditState state = state_of(standing_motion(kOffsetFrames));
  OpScene<OffsetOp> scene = lowered_hips();
  const auto out = scene.run(apply_offset, state);
  ASSERT_TRUE(out);
  const auto y = [&](std::size_t t) { return out->motion.poses[t].root_in_world.y; };
  double largest = 0.0;
  for (std::size_t t = 0; t + 3 < kOffsetFrames; ++t) {
    largest = std::max(largest, std::abs(y(t + 3) - 3 * y(t + 2) + 3 * y(t + 1) - y(t)));
  }
  const double step_s = 1.0 / 60.0;
  EXPECT_LT(largest, 0.1 * 60.0 * step_s * step_s * step_s);
}

TEST(OffsetOp, DisjointSpansCommuteToTheBit) {
  const EditState state = state_of(standing_motion(kOffsetFrames));
  OpScene<OffsetOp> a = lowered_hips();
  a.op.span = {AtTime{0.5}, AtTime{1.0}};
  a.op.blend_s = 0.3;
  OffsetOp turned;
  turned.bone = HumanBone::kChest;
  turned.rotation = glm::angleAxis(0.3, glm::dvec3(0, 1, 0));
  OpScene<OffsetOp> b(turned);
  b.op.span = {AtTime{2.0}, AtTime{3.0}};
  b.op.blend_s = 0.5;
  const auto first_a = a.run(apply_offset, state);
  const auto first_b = b.run(apply_offset, state);
  ASSERT_TRUE(first_a && first_b);
  const auto ab = b.run(apply_offset, *first_a);
  const auto ba = a.run(apply_offset, *first_b);
  ASSERT_TRUE(ab && ba);
  for (std::size_t t = 0; t < kOffsetFrames; ++t) {
    EXPECT_TRUE(same_pose(ab->motion.poses[t], ba->motion.poses[t])) << t;
  }
}

TEST(OffsetOp, ABoneThatTheBodyLacksIsRefusedWithItsName) {
  Motion motion = standing_motion(10);
  const auto toes = motion.skeleton.find(HumanBone::kLeftToes);
  motion.skeleton.joints[index(*toes)].bone.reset();
  const EditState state = state_of(motion);
  OffsetOp op;
  op.bone = HumanBone::kLeftToes;
  op.rotation = glm::angleAxis(0.3, glm::dvec3(1, 0, 0));
  OpScene<OffsetOp> scene(op);
  const auto out = scene.run(apply_offset, state);
  ASSERT_FALSE(out);
  EXPECT_NE(out.error().cause.find("leftToes"), std::string::npos);
}

}  // namespace
}  // namespace marey::edit
