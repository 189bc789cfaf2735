// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/retarget_op.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "edit/ops/constrain.h"
#include "edit/ops/contacts.h"
#include "edit/state/apply_contact_edits.h"
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

/// Largest way of the ankle from its place in the first of these frames, on the floor.
double ankle_drift_m(const Motion& motion, HumanBone foot, int first, int last) {
  const auto way = joint_way(motion, foot);
  double largest = 0.0;
  for (int t = first; t <= last; ++t) {
    const glm::dvec3 moved =
        way[static_cast<std::size_t>(t)] - way[static_cast<std::size_t>(first)];
    largest = std::max(largest, std::hypot(moved.x, moved.z));
  }
  return largest;
}

EditState noisy_walk() {
  Motion motion = testing::synthetic_walk(kRetargetFrames, 60.0).motion;
  add_motion_noise(motion, 3, 0.004, 0.001);
  return state_of(std::move(motion));
}

EditState with_edits(EditState state, std::vector<ContactEdit> edits) {
  state.contact_edits = std::move(edits);
  detect_contacts_again(state);
  return state;
}

EditState on_child(const EditState& state) {
  OpScene<RetargetOp> scene = onto(testing::child());
  auto out = scene.run(apply_retarget, state);
  EXPECT_TRUE(out) << (out ? "" : out.error().message());
  return out ? *std::move(out) : state;
}

TEST(RetargetOp, AContactThatWasClearedByHandIsNotHeldOnTheAvatar) {
  const EditState state = noisy_walk();
  const FrameRange run = state.contacts.feet[0].heel.at(1);
  std::vector<ContactEdit> edits;
  for (const FootPart part : {FootPart::kHeel, FootPart::kBall}) {
    edits.push_back({ContactEdit::Kind::kClear,
                     0,
                     part,
                     (run.first - 20) / 60.0,
                     (run.last + 20) / 60.0});
  }
  const EditState held = on_child(state);
  const EditState freed = on_child(with_edits(state, edits));
  EXPECT_LT(ankle_drift_m(held.motion, HumanBone::kLeftFoot, run.first, run.last), 1e-4);
  EXPECT_GT(ankle_drift_m(freed.motion, HumanBone::kLeftFoot, run.first, run.last), 2e-3);
}

TEST(RetargetOp, EdgesThatWereMovedByHandHoldOnTheAvatarAndAfterANewDetection) {
  const EditState state = noisy_walk();
  const FrameRange run = state.contacts.feet[1].heel.at(1);
  const EditState edited = with_edits(state,
                                      {{ContactEdit::Kind::kMoveStart,
                                        1,
                                        FootPart::kHeel,
                                        run.first / 60.0,
                                        (run.first - 4) / 60.0},
                                       {ContactEdit::Kind::kMoveEnd,
                                        1,
                                        FootPart::kHeel,
                                        run.last / 60.0,
                                        (run.last + 3) / 60.0}});
  const EditState avatar = on_child(edited);
  const FrameRange longer{run.first - 4, run.last + 3};
  EXPECT_EQ(avatar.contacts.feet[1].heel.at(1).first, longer.first);
  EXPECT_EQ(avatar.contacts.feet[1].heel.at(1).last, longer.last);
  const auto drift = [&](const EditState& s) {
    return ankle_drift_m(s.motion, HumanBone::kRightFoot, longer.first, longer.last);
  };
  EXPECT_LT(drift(avatar), 1e-4);
  EXPECT_GT(drift(on_child(state)), 5e-3);

  ContactsOp detect;
  detect.detect = true;
  OpScene<ContactsOp> scene(detect);
  const auto again = scene.run(apply_contacts, avatar);
  ASSERT_TRUE(again);
  // Detection may find other edges on the avatar; those of the edits are reached again if
  // the found edge is within reach of them.
  bool has_edges = false;
  for (const FrameRange& heel : again->contacts.feet[1].heel) {
    has_edges = has_edges || (heel.first == longer.first && heel.last == longer.last);
  }
  EXPECT_TRUE(has_edges);
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
