// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/exaggerate.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/edit/ops/op_scene.h"
#include "tests/edit/ops/standing_scene.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::edit {
namespace {

constexpr int kExaggerateFrames = 600;  // 10 s at 60 Hz.
constexpr double kSwing_rad = 0.1;

/// A standing adult whose left forearm swings at this frequency about one axis.
Motion swinging(double hz) {
  return standing_motion(kExaggerateFrames, [hz](int frame, Pose& pose) {
    const double angle =
        kSwing_rad * std::sin(2.0 * std::numbers::pi * hz * frame / 60.0);
    pose.parent_from_joint[static_cast<std::size_t>(HumanBone::kLeftLowerArm)] =
        glm::angleAxis(angle, glm::dvec3(0, 1, 0));
  });
}

/// Largest angle of the forearm from its middle, away from the ends.
double swing_of(const Motion& motion) {
  double largest = 0.0;
  for (std::size_t t = 120; t < 480; ++t) {
    const glm::dquat& q =
        motion.poses[t]
            .parent_from_joint[static_cast<std::size_t>(HumanBone::kLeftLowerArm)];
    largest = std::max(largest, glm::length(rotation_vector(q)));
  }
  return largest;
}

OpScene<ExaggerateOp> band(double gain, double low_hz, double high_hz) {
  return OpScene<ExaggerateOp>(ExaggerateOp{gain, low_hz, high_hz});
}

TEST(ExaggerateOp, AGainOfOneChangesNothing) {
  const EditState state = state_of(testing::synthetic_walk(180, 60.0).motion);
  for (const double low_hz : {0.0, 1.0}) {
    const auto out = band(1.0, low_hz, 5.0).run(apply_exaggerate, state);
    ASSERT_TRUE(out) << out.error().message();
    for (int t = 0; t < 180; ++t) {
      EXPECT_LT(pose_distance_m(out->motion, state.motion, t), 1e-9) << t;
    }
  }
}

TEST(ExaggerateOp, AGainOfTwoDoublesASwingInTheBand) {
  const EditState state = state_of(swinging(2.0));
  const auto out = band(2.0, 0.25, 12.0).run(apply_exaggerate, state);
  ASSERT_TRUE(out);
  const double swing = swing_of(state.motion);
  EXPECT_NEAR(swing_of(out->motion), 2.0 * swing, 0.01 * swing);
  const auto all = band(2.0, 0.0, 0.0).run(apply_exaggerate, state);
  ASSERT_TRUE(all);
  EXPECT_NEAR(swing_of(all->motion), 2.0 * swing, 0.001 * swing);
}

TEST(ExaggerateOp, ASwingOutsideOfTheBandStays) {
  const EditState slow = state_of(swinging(0.5));
  const auto above = band(2.0, 4.0, 12.0).run(apply_exaggerate, slow);
  ASSERT_TRUE(above);
  const double slow_swing = swing_of(slow.motion);
  EXPECT_NEAR(swing_of(above->motion), slow_swing, 0.01 * slow_swing);
  const EditState fast = state_of(swinging(8.0));
  const auto below = band(2.0, 0.2, 1.0).run(apply_exaggerate, fast);
  ASSERT_TRUE(below);
  const double fast_swing = swing_of(fast.motion);
  EXPECT_NEAR(swing_of(below->motion), fast_swing, 0.01 * fast_swing);
}

TEST(ExaggerateOp, OtherGroupsAndFramesStayToTheBit) {
  const EditState state = state_of(testing::synthetic_walk(240, 60.0).motion);
  OpScene<ExaggerateOp> scene = band(2.0, 0.0, 0.0);
  scene.op.groups = {EditGroup::kTrunk};
  scene.op.span = {AtFrame{100}, AtFrame{140}};
  scene.op.blend_s = 0.5;
  const auto out = scene.run(apply_exaggerate, state);
  ASSERT_TRUE(out);
  for (std::size_t t = 0; t < 240; ++t) {
    const Pose& is = out->motion.poses[t];
    const Pose& was = state.motion.poses[t];
    EXPECT_EQ(is.root_in_world, was.root_in_world);
    if (t <= 70 || t >= 170) {
      EXPECT_TRUE(same_pose(is, was)) << t;
    }
    for (std::size_t j = index(HumanBone::kLeftUpperLeg); j < is.parent_from_joint.size();
         ++j) {
      EXPECT_EQ(is.parent_from_joint[j], was.parent_from_joint[j]);
    }
  }
}

TEST(ExaggerateOp, StandingFeetStayWhereTheyStand) {
  const EditState state = state_of(testing::synthetic_walk(240, 60.0).motion);
  OpScene<ExaggerateOp> scene = band(1.5, 0.0, 0.0);
  const auto out = scene.run(apply_exaggerate, state);
  ASSERT_TRUE(out);
  for (std::size_t side = 0; side < 2; ++side) {
    const HumanBone foot = side == 0 ? HumanBone::kLeftFoot : HumanBone::kRightFoot;
    const auto was = joint_way(state.motion, foot);
    const auto is = joint_way(out->motion, foot);
    for (const FrameRange& run : state.contacts.feet[side].stance) {
      for (int t = run.first; t <= run.last; ++t) {
        const auto i = static_cast<std::size_t>(t);
        EXPECT_LT(glm::distance(is[i], was[i]),
                  1e-3 * scene.figure("feet_missed_mm") + 1e-9);
      }
    }
  }
  EXPECT_LT(scene.figure("feet_missed_mm"), 1.0);
}

TEST(ExaggerateOp, BadBandsAreRefusedWithTheirKey) {
  const EditState state = state_of(standing_motion(60));
  const auto where = [&](OpScene<ExaggerateOp> scene) {
    const auto out = scene.run(apply_exaggerate, state);
    EXPECT_FALSE(out);
    return out ? std::string() : out.error().where;
  };
  EXPECT_EQ(where(band(std::nan(""), 0.0, 0.0)), "gain");
  EXPECT_EQ(where(band(1.5, -1.0, 0.0)), "low_hz");
  EXPECT_EQ(where(band(1.5, 0.0, 30.0)), "high_hz");
  EXPECT_EQ(where(band(1.5, 5.0, 2.0)), "low_hz");
}

}  // namespace
}  // namespace marey::edit
