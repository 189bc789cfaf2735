// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/state/edit_state.h"

#include <cmath>
#include <limits>
#include <vector>

#include "edit/state/apply_contact_edits.h"
#include "edit/state/op_weights.h"
#include "edit/state/plant_feet.h"
#include "edit/state/resample_state.h"
#include "edit/state/resolve_moment.h"
#include <gtest/gtest.h>

#include "tests/edit/ops/op_scene.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::edit {
namespace {

EditState walk_state(int frames = 240, double hz = 120.0, double noise = 0.0) {
  return *make_edit_state(testing::synthetic_walk(frames, hz, noise, noise).motion);
}

bool same_poses(const Motion& a, const Motion& b) {
  if (a.poses.size() != b.poses.size()) return false;
  for (std::size_t t = 0; t < a.poses.size(); ++t) {
    if (a.poses[t].root_in_world != b.poses[t].root_in_world) return false;
    if (a.poses[t].parent_from_joint != b.poses[t].parent_from_joint) return false;
  }
  return true;
}

TEST(EditState, RefusesAMotionWithoutFrames) {
  Motion empty = testing::synthetic_walk(2, 30.0).motion;
  empty.poses.clear();
  const auto state = make_edit_state(empty);
  ASSERT_FALSE(state);
  EXPECT_EQ(state.error().cause, "has no frames");
}

TEST(EditState, NamesTheFrameWithANumberThatIsNotFinite) {
  Motion motion = testing::synthetic_walk(20, 30.0).motion;
  motion.poses[7].root_in_world.y = std::numeric_limits<double>::quiet_NaN();
  const auto state = make_edit_state(motion);
  ASSERT_FALSE(state);
  EXPECT_EQ(state.error().where, "frame 7");
}

TEST(EditState, AcceptsOneFrame) {
  const auto state = make_edit_state(testing::synthetic_walk(1, 30.0).motion);
  ASSERT_TRUE(state);
  EXPECT_EQ(state->duration_s(), 0.0);
}

TEST(ResolveMoment, FindsTimesFramesAndStrikes) {
  const EditState state = walk_state();
  EXPECT_DOUBLE_EQ(*resolve_moment(state, AtTime{0.5}), 60.0);
  EXPECT_DOUBLE_EQ(*resolve_moment(state, AtFrame{12.5}), 12.5);
  const auto events = contact_events(state);
  ASSERT_GE(events.size(), 4U);
  const auto strike = resolve_moment(state, AtAnnotation{"left.strike", 0});
  ASSERT_TRUE(strike);
  const FrameRange stance = state.contacts.feet[0].stance[0].first > 0
                                ? state.contacts.feet[0].stance[0]
                                : state.contacts.feet[0].stance[1];
  EXPECT_NEAR(*strike, stance.first, 1e-9);
}

TEST(ResolveMoment, SuggestsTheNearestAnnotation) {
  const auto frame = resolve_moment(walk_state(), AtAnnotation{"left.strik", 0});
  ASSERT_FALSE(frame);
  EXPECT_NE(frame.error().next.find("left.strike"), std::string::npos);
}

TEST(ResolveMoment, RefusesAnInstantBeyondTheMotion) {
  const auto frame = resolve_moment(walk_state(), AtTime{2.5});
  ASSERT_FALSE(frame);
  EXPECT_NE(frame.error().cause.find("1.992 s"), std::string::npos);
}

TEST(ResolveSpan, RefusesAReversedSpan) {
  const auto span = resolve_span(walk_state(), {AtTime{1.0}, AtTime{0.5}});
  ASSERT_FALSE(span);
  EXPECT_NE(span.error().cause.find("before it starts"), std::string::npos);
}

TEST(ResampleState, KeepsWholeFramesToTheBit) {
  const EditState state = walk_state(60, 30.0, 0.01);
  const EditState part = slice_state(state, {10, 39});
  ASSERT_EQ(part.frame_count(), 30);
  for (std::size_t t = 0; t < 30; ++t) {
    EXPECT_EQ(part.motion.poses[t].root_in_world,
              state.motion.poses[t + 10].root_in_world);
    EXPECT_EQ(part.lineage.frames[t].source_frame, static_cast<double>(t + 10));
  }
}

TEST(ResampleState, FollowsASmoothTurnWithinAMicroradian) {
  // A joint that turns by a sine of 2 Hz, sampled at 60 Hz and read between the samples.
  EditState state = walk_state(61, 60.0);
  const auto angle = [](double t) { return 0.8 * std::sin(2.0 * M_PI * 2.0 * t); };
  for (int t = 0; t < 61; ++t) {
    state.motion.poses[static_cast<std::size_t>(t)].parent_from_joint[5] =
        glm::angleAxis(angle(t / 60.0), glm::dvec3(0.6, 0.0, 0.8));
  }
  std::vector<double> at_frame;
  for (double at = 10.25; at < 50.0; at += 0.5) at_frame.push_back(at);
  const EditState out = resample_state(state, at_frame, 120.0);
  for (std::size_t k = 0; k < at_frame.size(); ++k) {
    const glm::dquat truth =
        glm::angleAxis(angle(at_frame[k] / 60.0), glm::dvec3(0.6, 0.0, 0.8));
    const double dot =
        std::abs(glm::dot(truth, out.motion.poses[k].parent_from_joint[5]));
    EXPECT_LT(2.0 * std::acos(std::min(1.0, dot)), 2e-4) << k;
  }
}

TEST(ResampleState, MovesAnnotationsWithTheirFrames) {
  EditState state = walk_state();
  state.annotations.notes = {{"a", 0.25, 0.25}, {"b", 0.5, 1.0}, {"c", 1.5, 1.5}};
  const EditState part = slice_state(state, {60, 120});
  ASSERT_EQ(part.annotations.notes.size(), 1U);
  EXPECT_EQ(part.annotations.notes[0].text, "b");
  EXPECT_NEAR(part.annotations.notes[0].start_s, 0.0, 1e-12);
  EXPECT_NEAR(part.annotations.notes[0].end_s, 0.5, 1e-12);
}

TEST(PlantFeet, StandsNoisyFeetStillToATenthOfAMillimetre) {
  for (int seed = 0; seed < 20; ++seed) {
    Motion motion = testing::synthetic_walk(240, 120.0).motion;
    add_motion_noise(motion, static_cast<std::uint64_t>(seed), 0.004, 0.001);
    EditState state = *make_edit_state(motion);
    const PlantReport report = plant_feet(state);
    EXPECT_GT(report.slide_before_mm, 1.0);
    // Measured here, not by the report.
    for (int side = 0; side < 2; ++side) {
      const auto way = joint_way(
          state.motion, side == 0 ? HumanBone::kLeftFoot : HumanBone::kRightFoot);
      for (const FrameRange& run :
           state.contacts.feet[static_cast<std::size_t>(side)].heel) {
        for (int frame = run.first; frame <= run.last; ++frame) {
          const glm::dvec3 moved = way[static_cast<std::size_t>(frame)] -
                                   way[static_cast<std::size_t>(run.first)];
          EXPECT_LT(std::hypot(moved.x, moved.z), 1e-4) << "seed " << seed;
        }
      }
    }
  }
}

TEST(PlantFeet, LeavesArmsAndTrunkToTheBit) {
  EditState state = walk_state(120, 60.0, 0.003);
  const Motion before = state.motion;
  (void)plant_feet(state);
  const auto arm = index(*before.skeleton.find(HumanBone::kLeftLowerArm));
  for (std::size_t t = 0; t < before.poses.size(); ++t) {
    EXPECT_EQ(state.motion.poses[t].parent_from_joint[arm],
              before.poses[t].parent_from_joint[arm]);
    EXPECT_EQ(state.motion.poses[t].parent_from_joint[0],
              before.poses[t].parent_from_joint[0]);
  }
}

TEST(ContactEdits, MoveAnEdgeAndSurviveANewDetection) {
  EditState state = walk_state();
  const FrameRange stance = state.contacts.feet[0].heel.at(1);
  const double hz = state.motion.rate.hz;
  state.contact_edits.push_back({ContactEdit::Kind::kMoveStart,
                                 0,
                                 FootPart::kHeel,
                                 stance.first / hz,
                                 (stance.first - 5) / hz});
  detect_contacts_again(state);
  EXPECT_EQ(state.contacts.feet[0].heel.at(1).first, stance.first - 5);
  EXPECT_EQ(state.contacts.feet[0].heel.at(1).last, stance.last);
}

TEST(ContactEdits, FarFromAnyEdgeChangeNothing) {
  EditState state = walk_state();
  const auto before = state.contacts.feet[1].heel;
  const std::vector<ContactEdit> edits{
      {ContactEdit::Kind::kMoveEnd, 1, FootPart::kHeel, 0.0, 0.1}};
  ASSERT_GT(before.front().last, 13);
  apply_contact_edits(state, edits);
  ASSERT_EQ(state.contacts.feet[1].heel.size(), before.size());
  EXPECT_EQ(state.contacts.feet[1].heel.front().last, before.front().last);
}

TEST(MixMotion, KeepsFramesOutsideTheSpanToTheBit) {
  const EditState state = walk_state();
  EditState moved = state;
  for (Pose& pose : moved.motion.poses) pose.root_in_world.x += 0.1;
  EditOp op{PlantOp{}};
  op.span = {AtTime{0.5}, AtTime{1.0}};
  op.blend_s = 0.1;
  const auto weights = op_weights(state, op);
  ASSERT_TRUE(weights);
  mix_motion(state.motion, *weights, state, {}, moved.motion);
  for (std::size_t t = 0; t < moved.motion.poses.size(); ++t) {
    const double x = moved.motion.poses[t].root_in_world.x;
    const double old = state.motion.poses[t].root_in_world.x;
    if (t <= 48 || t >= 132) {
      EXPECT_EQ(x, old) << t;
    } else if (t >= 60 && t <= 120) {
      EXPECT_EQ(x, old + 0.1) << t;
    }
  }
}

TEST(Lineage, RecordsTheOperationsOfEachFrame) {
  Lineage lineage = lineage_of_source(0, 10);
  touch(lineage, {2, 5}, 0);
  touch(lineage, {4, 8}, 3);
  EXPECT_TRUE(ops_of(lineage, 0).empty());
  EXPECT_EQ(ops_of(lineage, 3), std::vector<int>{0});
  EXPECT_EQ(ops_of(lineage, 4), (std::vector<int>{0, 3}));
  EXPECT_EQ(ops_of(lineage, 8), std::vector<int>{3});
  EXPECT_TRUE(same_poses(walk_state().motion, walk_state().motion));
}

}  // namespace
}  // namespace marey::edit
