// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/ops/splice.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/resample.h"
#include "tests/edit/ops/splice_scene.h"

namespace marey::edit {
namespace {

void expect_same_runs(const std::vector<FrameRange>& a,
                      const std::vector<FrameRange>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].first, b[k].first);
    EXPECT_EQ(a[k].last, b[k].last);
  }
}

void expect_same_state(const EditState& a, const EditState& b) {
  ASSERT_EQ(a.frame_count(), b.frame_count());
  for (std::size_t t = 0; t < a.motion.poses.size(); ++t) {
    ASSERT_EQ(a.motion.poses[t].root_in_world, b.motion.poses[t].root_in_world) << t;
    ASSERT_EQ(a.motion.poses[t].parent_from_joint, b.motion.poses[t].parent_from_joint)
        << t;
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const auto& x = a.contacts.feet[side];
    const auto& y = b.contacts.feet[side];
    expect_same_runs(x.heel, y.heel);
    expect_same_runs(x.ball, y.ball);
    expect_same_runs(x.stance, y.stance);
    expect_same_runs(x.heel_up, y.heel_up);
  }
}

// Largest speed of a bearing ankle or toe joint between two frames, by its own forward
// kinematics and the contacts of the result. [m/s]
double worst_slide(const EditState& state, const FrameRange& frames) {
  double worst = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto& foot = state.contacts.feet[side];
    const auto measure = [&](HumanBone bone, const std::vector<FrameRange>& runs) {
      const auto way = joint_way(state.motion, bone);
      for (const FrameRange& run : runs) {
        for (int t = std::max(run.first, frames.first) + 1;
             t <= std::min(run.last, frames.last);
             ++t) {
          glm::dvec3 step =
              way[static_cast<std::size_t>(t)] - way[static_cast<std::size_t>(t - 1)];
          step.y = 0.0;
          worst = std::max(worst, glm::length(step) * state.motion.rate.hz);
        }
      }
    };
    measure(side == 0 ? HumanBone::kLeftFoot : HumanBone::kRightFoot, foot.heel);
    measure(side == 0 ? HumanBone::kLeftToes : HumanBone::kRightToes, foot.ball);
  }
  return worst;
}

void expect_same_notes(const EditState& a, const EditState& b) {
  ASSERT_EQ(a.annotations.notes.size(), b.annotations.notes.size());
  for (std::size_t k = 0; k < a.annotations.notes.size(); ++k) {
    EXPECT_EQ(a.annotations.notes[k].text, b.annotations.notes[k].text);
    EXPECT_NEAR(a.annotations.notes[k].start_s, b.annotations.notes[k].start_s, 1e-12);
    EXPECT_NEAR(a.annotations.notes[k].end_s, b.annotations.notes[k].end_s, 1e-12);
  }
  EXPECT_EQ(a.annotations.curves, b.annotations.curves);
  ASSERT_EQ(a.constraints.constraints.size(), b.constraints.constraints.size());
  for (std::size_t k = 0; k < a.constraints.constraints.size(); ++k) {
    const Constraint& x = a.constraints.constraints[k];
    const Constraint& y = b.constraints.constraints[k];
    EXPECT_EQ(x.id, y.id);
    EXPECT_NEAR(
        x.activation.start_s.value_or(-1), y.activation.start_s.value_or(-1), 1e-12);
    EXPECT_NEAR(
        x.activation.stop_s.value_or(-1), y.activation.stop_s.value_or(-1), 1e-12);
  }
}

TEST(Splice, CutAndSplicedToItsOwnRestIsItselfToTheBit) {
  const EditState walk = walk_with_notes();
  for (const int at : {1, 60, 150, 199, 328}) {
    const EditState cut = slice_state(walk, {0, at});
    for (const double overlap_s : {0.0, 0.3}) {
      SpliceOp op;
      op.at = AtFrame{static_cast<double>(at)};
      op.enter_at = op.at;
      op.overlap_s = overlap_s;
      // The whole source again, entered at the same frame.
      auto scene = splice_scene(as_source(walk, {0, 329}, 1), op);
      const auto joined = scene.run(apply_splice, cut);
      ASSERT_TRUE(joined) << joined.error().message();
      expect_same_state(walk, *joined);
      expect_same_notes(walk, *joined);
      EXPECT_EQ(scene.figure("unchanged"), 1.0);
      // Its rest alone, from the frame of the cut on.
      op.enter_at = AtFrame{0.0};
      auto rest = splice_scene(as_source(walk, {at, 329}, 1), op);
      const auto again = rest.run(apply_splice, cut);
      ASSERT_TRUE(again) << again.error().message();
      expect_same_state(walk, *again);
      expect_same_notes(walk, *again);
    }
  }
}

TEST(Splice, FindsTheIdenticalFramesItself) {
  const EditState walk = splice_walk(0.02);
  auto scene = splice_scene(as_source(walk, {100, 329}, 1));
  const auto joined = scene.run(apply_splice, slice_state(walk, {0, 220}));
  ASSERT_TRUE(joined) << joined.error().message();
  expect_same_state(walk, *joined);
}

TEST(Splice, WalkJoinsItselfACycleLaterWithoutSlide) {
  const EditState walk = splice_walk();
  for (const int at : {150, 165, 180, 200, 215}) {
    SpliceOp op;
    op.at = AtFrame{static_cast<double>(at)};
    op.enter_at = AtFrame{static_cast<double>(at - kSpliceCycle)};
    auto scene = splice_scene(
        moved_on_floor(as_source(walk, {0, 329}, 1), 2.0, {3.0, 0.02, 1.0}), op);
    const auto joined = scene.run(apply_splice, walk);
    ASSERT_TRUE(joined) << joined.error().message();
    ASSERT_EQ(joined->frame_count(), 330 + kSpliceCycle);
    EXPECT_LT(worst_slide(*joined, {at - 15, at + 15}), 1e-4 /* m/s */);
    // The walk goes on as if it had never been joined.
    const EditState longer = splice_walk(0.0, 330 + kSpliceCycle);
    const auto truth = joint_way(longer.motion, HumanBone::kHead);
    const auto head = joint_way(joined->motion, HumanBone::kHead);
    for (std::size_t t = 0; t < head.size(); ++t) {
      EXPECT_LT(glm::distance(head[t], truth[t]), 2e-3 /* m */) << t;
    }
  }
}

TEST(Splice, TurnedAndMovedSourceGivesTheSameResult) {
  const EditState first = splice_walk(0.01);
  const EditState second = as_source(splice_walk(0.012, 290), {40, 289}, 1);
  for (const double overlap_s : {0.0, 0.3}) {
    SpliceOp op;
    op.overlap_s = overlap_s;
    auto plain = splice_scene(second, op);
    auto moved = splice_scene(moved_on_floor(second, -2.4, {-7.0, 0.3, 11.0}), op);
    const auto a = plain.run(apply_splice, first);
    const auto b = moved.run(apply_splice, first);
    ASSERT_TRUE(a && b);
    ASSERT_EQ(a->frame_count(), b->frame_count());
    for (std::size_t t = 0; t < a->motion.poses.size(); ++t) {
      const auto x = world_from_joints(a->motion.skeleton, a->motion.poses[t]);
      const auto y = world_from_joints(b->motion.skeleton, b->motion.poses[t]);
      for (std::size_t j = 0; j < x.size(); ++j) {
        ASSERT_LT(glm::distance(x[j].translation, y[j].translation), 1e-9) << t;
      }
    }
  }
}

TEST(Splice, PlantedFeetStandAcrossTheJoin) {
  const EditState first = splice_walk(0.01);
  const EditState second = as_source(splice_walk(0.015, 300), {30, 299}, 1);
  ASSERT_FALSE(second.contacts.feet[0].stance.empty());
  auto scene = splice_scene(moved_on_floor(second, 0.7, {1.0, 0.0, 2.0}));
  const auto joined = scene.run(apply_splice, first);
  ASSERT_TRUE(joined);
  const int at = static_cast<int>(scene.figure("leave_frame"));
  EXPECT_LT(worst_slide(*joined, {at - 15, at + 15}), 0.003 /* m/s */);
}

// The contact ends two frames before the join in one motion and begins two frames after
// it in the other one.
TEST(Splice, StanceWithAGapAtTheJoinHasOneFootprint) {
  EditState first = splice_walk();
  EditState second = as_source(first, {0, 329}, 1);
  int at = 0;
  for (const FrameRange& run : first.contacts.feet[0].stance) {
    if (run.first > 100 && at == 0) at = (run.first + run.last) / 2;
  }
  const auto set_runs = [](EditState& state, const FrameRange& run) {
    FootContacts& foot = state.contacts.feet[0];
    foot.heel = {run};
    foot.ball = {run};
    foot.stance = {run};
    foot.heel_up.clear();
  };
  set_runs(first, {at - 12, at - 2});
  set_runs(second, {at + 3, at + 12});
  for (Pose& pose : second.motion.poses) pose.root_in_world.x += 0.01;
  SpliceOp op;
  op.at = AtFrame{static_cast<double>(at)};
  op.enter_at = op.at;
  auto scene = splice_scene(second, op);
  const auto joined = scene.run(apply_splice, first);
  ASSERT_TRUE(joined) << joined.error().message();
  ASSERT_EQ(joined->contacts.feet[0].stance.size(), 1U);
  EXPECT_LT(worst_slide(*joined, {at - 12, at + 12}), 1e-4 /* m/s */);
}

// The arm of the second motion swings past half a turn from that of the first one. Mixed
// the shorter way frame by frame, it would change sides within one frame.
TEST(Splice, RotationsHalfATurnApartAreMixedOneWayRound) {
  const EditState first = splice_walk();
  EditState second = as_source(first, {0, 329}, 1);
  const std::size_t arm = index(*first.motion.skeleton.find(HumanBone::kLeftUpperArm));
  for (std::size_t t = 0; t < second.motion.poses.size(); ++t) {
    const double angle_rad = 3.14159 + 0.02 * (static_cast<double>(t) - 90.0);
    glm::dquat& q = second.motion.poses[t].parent_from_joint[arm];
    q = q * rotation_from_vector({angle_rad, 0.0, 0.0});
  }
  SpliceOp op;
  op.at = AtFrame{200};
  op.enter_at = AtFrame{90};
  auto scene = splice_scene(second, op);
  const auto joined = scene.run(apply_splice, first);
  ASSERT_TRUE(joined);
  for (std::size_t t = 180; t < 220; ++t) {
    const glm::dquat step =
        glm::conjugate(joined->motion.poses[t].parent_from_joint[arm]) *
        joined->motion.poses[t + 1].parent_from_joint[arm];
    // Half a turn over 30 frames with weights that change by 1/16 a frame at most.
    EXPECT_LT(glm::length(rotation_vector(std::abs(step.w) == step.w ? step : -step)),
              0.3)
        << t;
  }
}

// Both one-sided velocities at the join agree up to the accelerations of the motion.
TEST(Splice, WithoutAnOverlapValuesAndVelocitiesMeet) {
  const EditState first = splice_walk();
  EditState second = as_source(first, {0, 329}, 1);
  // A posture and a velocity that differ: the root sways, a joint turns.
  for (std::size_t t = 0; t < second.motion.poses.size(); ++t) {
    const double time = static_cast<double>(t) / 100.0;
    Pose& pose = second.motion.poses[t];
    pose.root_in_world.y += 0.03 + 0.2 * (time - 0.9);
    pose.parent_from_joint[3] =
        pose.parent_from_joint[3] * rotation_from_vector({0.0, 0.4 + 0.8 * time, 0.2});
  }
  SpliceOp op;
  op.at = AtFrame{200};
  op.enter_at = AtFrame{90};
  op.overlap_s = 0.0;
  auto scene = splice_scene(second, op);
  scene.op.blend_s = 0.4;
  const auto joined = scene.run(apply_splice, first);
  ASSERT_TRUE(joined);
  const auto turn = [&](int t) {
    const auto& poses = joined->motion.poses;
    return rotation_vector(
        glm::conjugate(poses[static_cast<std::size_t>(t)].parent_from_joint[3]) *
        poses[static_cast<std::size_t>(t + 1)].parent_from_joint[3]);
  };
  EXPECT_LT(glm::length(turn(200) - turn(199)) * 100.0, 0.03 /* rad/s, of 0.8 */);
  EXPECT_LT(glm::length(turn(200)) * 100.0, 0.8);
  // Beyond the blend, both are as they were.
  for (const int t : {100, 155}) {
    EXPECT_EQ(joined->motion.poses[static_cast<std::size_t>(t)].parent_from_joint[3],
              first.motion.poses[static_cast<std::size_t>(t)].parent_from_joint[3]);
  }
  EXPECT_EQ(joined->motion.poses[245].parent_from_joint[3],
            second.motion.poses[135].parent_from_joint[3]);
}

TEST(Splice, SourceAtAnotherRateIsResampled) {
  const EditState first = splice_walk();
  const EditState second = as_source(first, {0, 329}, 1);
  EditState slower = second;
  std::vector<double> at_frame;
  for (int k = 0; 100.0 / 40.0 * k <= 329.0; ++k) at_frame.push_back(2.5 * k);
  slower = resample_state(second, at_frame, 40.0);
  SpliceOp op;
  op.at = AtTime{2.0};
  op.enter_at = AtTime{0.9};
  auto same = splice_scene(second, op);
  auto other = splice_scene(slower, op);
  const auto a = same.run(apply_splice, first);
  const auto b = other.run(apply_splice, first);
  ASSERT_TRUE(a && b);
  EXPECT_TRUE(other.has_finding("rate"));
  EXPECT_FALSE(same.has_finding("rate"));
  EXPECT_EQ(b->motion.rate.hz, 100.0);
  const auto head_a = joint_way(a->motion, HumanBone::kHead);
  const auto head_b = joint_way(b->motion, HumanBone::kHead);
  for (std::size_t t = 0; t < std::min(head_a.size(), head_b.size()); ++t) {
    EXPECT_LT(glm::distance(head_a[t], head_b[t]), 0.01 /* m */) << t;
  }
}

TEST(Splice, SourceOnAnotherBodyTakesTheFirstBody) {
  const EditState first = splice_walk();
  // A child of 0.7 of the size.
  Motion child = splice_walk().motion;
  for (Joint& joint : child.skeleton.joints) {
    joint.parent_from_joint.translation *= 0.7;
    if (joint.tip_in_joint) *joint.tip_in_joint *= 0.7;
  }
  for (Pose& pose : child.poses) pose.root_in_world *= 0.7;
  auto next = make_edit_state(std::move(child), {}, 1);
  ASSERT_TRUE(next);
  SpliceOp op;
  op.at = AtFrame{200};
  op.enter_at = AtFrame{90};
  auto scene = splice_scene(*next, op);
  const auto joined = scene.run(apply_splice, first);
  ASSERT_TRUE(joined) << joined.error().message();
  EXPECT_TRUE(scene.has_finding("body"));
  ASSERT_EQ(joined->frame_count(), 330 + kSpliceCycle);
  const auto truth =
      joint_way(splice_walk(0.0, 330 + kSpliceCycle).motion, HumanBone::kHead);
  const auto head = joint_way(joined->motion, HumanBone::kHead);
  EXPECT_LT(glm::distance(head.back(), truth.back()), 0.05 /* m */);
}

TEST(Splice, NotesAndConstraintsMoveInTimeAndSpace) {
  const EditState first = splice_walk(0.02);
  EditState second = as_source(splice_walk(0.03), {0, 329}, 1);
  const auto hand = joint_way(second.motion, HumanBone::kLeftHand);
  second.annotations.notes = {{"early", 0.1, 0.1}, {"wave", 2.0, 2.5}};
  Constraint reach;
  reach.id = "reach";
  reach.point.segment = "leftHand";
  reach.goal = DistanceToPoint{0.0, hand[250]};
  reach.activation.start_s = 2.0;
  reach.activation.stop_s = 2.6;
  second.constraints.constraints = {reach};
  SpliceOp op;
  op.at = AtFrame{210};
  op.enter_at = AtFrame{100};
  auto scene = splice_scene(moved_on_floor(second, 1.0, {5.0, 0.0, 5.0}), op);
  const auto joined = scene.run(apply_splice, first);
  ASSERT_TRUE(joined);
  ASSERT_EQ(joined->annotations.notes.size(), 1U);
  EXPECT_NEAR(joined->annotations.notes[0].start_s, 3.1, 1e-9);
  EXPECT_NEAR(joined->annotations.notes[0].end_s, 3.6, 1e-9);
  ASSERT_EQ(joined->constraints.constraints.size(), 1U);
  const Constraint& moved = joined->constraints.constraints[0];
  EXPECT_NEAR(*moved.activation.start_s, 3.1, 1e-9);
  EXPECT_LT(glm::distance(std::get<DistanceToPoint>(moved.goal).p_in_world,
                          joint_way(joined->motion, HumanBone::kLeftHand)[360]),
            1e-6 /* m */);
}

TEST(Splice, OverlapIsInferredAndTheRestMeasured) {
  const EditState first = splice_walk(0.02);
  SpliceOp op;
  op.at = AtFrame{210};
  op.enter_at = AtFrame{100};
  auto scene = splice_scene(as_source(splice_walk(0.05), {0, 329}, 1), op);
  const auto joined = scene.run(apply_splice, first);
  ASSERT_TRUE(joined);
  const auto& frames = joined->lineage.frames;
  ASSERT_EQ(static_cast<int>(frames.size()), joined->frame_count());
  for (int t = 196; t <= 224; ++t) {
    EXPECT_EQ(frames[static_cast<std::size_t>(t)].trust, Source::kInferred) << t;
    EXPECT_EQ(ops_of(joined->lineage, t), std::vector<int>{0}) << t;
  }
  EXPECT_EQ(frames[50].trust, Source::kMeasured);
  EXPECT_EQ(frames[50].source, 0);
  EXPECT_EQ(frames[400].trust, Source::kMeasured);
  EXPECT_EQ(frames[400].source, 1);
  EXPECT_NEAR(frames[400].source_frame, 290.0, 1e-9);
  // Far from the join nothing changes, to the bit.
  EXPECT_EQ(joined->motion.poses[50].parent_from_joint,
            first.motion.poses[50].parent_from_joint);
}

}  // namespace
}  // namespace marey::edit
