// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/retarget_op.h"

#include <cstddef>
#include <string>
#include <variant>

#include "edit/ops/constrain.h"
#include "edit/state/plant_feet.h"
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/edit/ops/op_scene.h"
#include "tests/edit/ops/standing_scene.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::edit {
namespace {

constexpr int kRetargetFrames = 240;

OpScene<RetargetOp> onto(const Skeleton& avatar) {
  OpScene<RetargetOp> scene(RetargetOp{"avatar.vrm", false});
  scene.inputs.avatars["avatar.vrm"] = avatar;
  return scene;
}

EditState walk_with_supports() {
  EditState state = state_of(testing::synthetic_walk(kRetargetFrames, 60.0).motion);
  state.uncertainty.assign(
      kRetargetFrames,
      std::vector<JointUncertainty>(state.motion.skeleton.joints.size(),
                                    {0.01, Source::kMeasured, Source::kMeasured}));
  state.annotations.notes = {{"walk", 0.0, 1.0}};
  ConstrainOp detect;
  detect.detect = DetectConstraints::kSupports;
  OpScene<ConstrainOp> scene(detect);
  auto out = scene.run(apply_constrain, state);
  EXPECT_TRUE(out);
  return *std::move(out);
}

TEST(RetargetOp, TheOwnBodyKeepsTheMotionAndItsConstraints) {
  const EditState state = walk_with_supports();
  OpScene<RetargetOp> scene = onto(state.motion.skeleton);
  const auto out = scene.run(apply_retarget, state);
  ASSERT_TRUE(out) << out.error().message();
  EXPECT_NEAR(scene.figure("scale"), 1.0, 1e-12);
  for (int t = 0; t < kRetargetFrames; ++t) {
    // Hips sink where a leg is straighter than retargeting allows.
    EXPECT_LT(pose_distance_m(out->motion, state.motion, t), 3e-2) << t;
  }
  ASSERT_EQ(out->constraints.constraints.size(), state.constraints.constraints.size());
  for (std::size_t i = 0; i < out->constraints.constraints.size(); ++i) {
    const auto& was = std::get<Support>(state.constraints.constraints[i].goal);
    const auto& is = std::get<Support>(out->constraints.constraints[i].goal);
    EXPECT_LT(glm::distance(*is.footprint_in_world, *was.footprint_in_world), 5e-3)
        << state.constraints.constraints[i].id;
  }
}

TEST(RetargetOp, FootprintsAreThoseOfTheAvatarAndSigmasAreScaled) {
  const EditState state = walk_with_supports();
  OpScene<RetargetOp> scene = onto(testing::child());
  const auto out = scene.run(apply_retarget, state);
  ASSERT_TRUE(out) << out.error().message();
  const double scale = scene.figure("scale");
  EXPECT_LT(scale, 0.8);
  EXPECT_NEAR(out->uncertainty[10][5].sigma_m, 0.01 * scale, 1e-12);
  EXPECT_EQ(out->uncertainty[10].size(), out->motion.skeleton.joints.size());
  EXPECT_EQ(out->annotations, state.annotations);
  EXPECT_EQ(ops_of(out->lineage, 17), std::vector<int>{0});
  EXPECT_EQ(out->lineage.frames[17].source_frame, 17.0);
  EXPECT_LT(measure_slide(*out).worst_drift_mm, 1.0);
  // Adapted to its supports, the avatar does not move: they are its own.
  ConstrainOp adapt;
  adapt.adapt = true;
  OpScene<ConstrainOp> now(adapt);
  const auto adapted = now.run(apply_constrain, *out);
  ASSERT_TRUE(adapted) << adapted.error().message();
  EXPECT_EQ(now.figure("unmet"), 0.0);
  EXPECT_LT(now.figure("displaced_mm"), 0.1);
}

TEST(RetargetOp, AnAvatarThatWasNotReadIsRefusedWithTheNearestName) {
  OpScene<RetargetOp> scene = onto(testing::child());
  std::get<RetargetOp>(scene.op.parameters).avatar = "avatr.vrm";
  const auto out = scene.run(apply_retarget, state_of(standing_motion(30)));
  ASSERT_FALSE(out);
  EXPECT_NE(out.error().next.find("avatar.vrm"), std::string::npos);
}

TEST(RetargetOp, AConstraintOfASegmentThatTheAvatarLacksIsDroppedAndReported) {
  EditState state = state_of(standing_motion(60));
  Constraint look;
  look.id = "look";
  look.point.segment = "upperChest";
  look.goal = SegmentOrientation{};
  Constraint grip;
  grip.id = "grip";
  grip.point.segment = "leftHand";
  grip.goal = DistanceToPoint{0.1, {0.2, 1.0, 0.4}};
  state.constraints.constraints = {look, grip};
  OpScene<RetargetOp> scene =
      onto(testing::without(testing::giant(), HumanBone::kUpperChest));
  const auto out = scene.run(apply_retarget, state);
  ASSERT_TRUE(out) << out.error().message();
  ASSERT_EQ(out->constraints.constraints.size(), 1U);
  EXPECT_TRUE(scene.has_finding("dropped"));
  const auto& goal = std::get<DistanceToPoint>(out->constraints.constraints[0].goal);
  const double scale = scene.figure("scale");
  EXPECT_NEAR(goal.distance_m, 0.1 * scale, 1e-12);
  EXPECT_NEAR(goal.p_in_world.x, 0.2 * scale, 1e-12);
  EXPECT_NEAR(goal.p_in_world.z, 0.4 * scale, 1e-12);
}

}  // namespace
}  // namespace marey::edit
