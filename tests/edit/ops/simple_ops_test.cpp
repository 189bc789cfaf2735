// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "edit/ops/annotate.h"
#include "edit/ops/contacts.h"
#include "edit/ops/cut.h"
#include "edit/ops/mirror.h"
#include "edit/ops/place.h"
#include "edit/ops/plant.h"
#include "edit/ops/retime.h"
#include "edit/state/mirror_names.h"
#include "edit/state/resolve_moment.h"
#include <gtest/gtest.h>

#include "tests/edit/ops/op_scene.h"

namespace marey::edit {
namespace {

EditState disturbed_walk(std::uint64_t seed, int frames = 240, double hz = 120.0) {
  Motion motion = testing::synthetic_walk(frames, hz).motion;
  add_motion_noise(motion, seed, 0.02, 0.002);
  return *make_edit_state(motion);
}

double simple_difference_m(const Motion& a, const Motion& b) {
  double largest = 0.0;
  for (std::size_t t = 0; t < a.poses.size(); ++t) {
    const auto first = world_from_joints(a.skeleton, a.poses[t]);
    const auto second = world_from_joints(b.skeleton, b.poses[t]);
    for (std::size_t j = 0; j < first.size(); ++j) {
      largest =
          std::max(largest, glm::distance(first[j].translation, second[j].translation));
    }
  }
  return largest;
}

TEST(Cut, KeepsTheFramesOfItsSpanToTheBit) {
  const EditState state = disturbed_walk(1);
  OpScene scene{CutOp{}};
  scene.op.span = {AtFrame{30}, AtFrame{90}};
  const auto out = scene.run(apply_cut, state);
  ASSERT_TRUE(out);
  ASSERT_EQ(out->frame_count(), 61);
  for (std::size_t t = 0; t < 61; ++t) {
    EXPECT_EQ(out->motion.poses[t].parent_from_joint,
              state.motion.poses[t + 30].parent_from_joint);
  }
}

TEST(Cut, KeepsTheWholeMotionWithoutASpan) {
  EditState state = disturbed_walk(2);
  state.motion.first_frame = 17;
  OpScene scene{CutOp{}};
  const auto out = scene.run(apply_cut, state);
  ASSERT_TRUE(out);
  EXPECT_EQ(out->motion.first_frame, 17);
  EXPECT_EQ(simple_difference_m(out->motion, state.motion), 0.0);
}

TEST(Cut, RefusesGroups) {
  OpScene scene{CutOp{}};
  scene.op.groups = {EditGroup::kHead};
  const auto out = scene.run(apply_cut, disturbed_walk(3));
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().where, "groups");
}

TEST(Split, GivesPartsThatTogetherAreTheMotion) {
  const EditState state = disturbed_walk(4);
  OpReport report;
  EditOp op{SplitOp{{AtTime{0.5}, AtTime{1.25}}}};
  const EditInputs inputs;
  const auto parts =
      apply_split(std::get<SplitOp>(op.parameters), {op, 0, inputs}, state, report);
  ASSERT_TRUE(parts);
  ASSERT_EQ(parts->size(), 3U);
  std::size_t frame = 0;
  for (const EditState& part : *parts) {
    for (const Pose& pose : part.motion.poses) {
      EXPECT_EQ(pose.root_in_world, state.motion.poses[frame++].root_in_world);
    }
  }
  EXPECT_EQ(frame, state.motion.poses.size());
}

TEST(Mirror, TwiceGivesTheMotionBack) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const EditState state = disturbed_walk(seed, 60);
    OpScene scene{MirrorOp{}};
    const auto once = scene.run(apply_mirror, state);
    ASSERT_TRUE(once);
    const auto twice = scene.run(apply_mirror, *once);
    ASSERT_TRUE(twice);
    EXPECT_LT(simple_difference_m(twice->motion, state.motion), 1e-12);
  }
}

TEST(Mirror, PutsEachJointOfASymmetricBodyAtTheImageOfItsCounterpart) {
  const EditState state = disturbed_walk(5, 60);
  OpScene scene{MirrorOp{}};
  const auto out = scene.run(apply_mirror, state);
  ASSERT_TRUE(out);
  for (const HumanBone bone :
       {HumanBone::kLeftHand, HumanBone::kRightFoot, HumanBone::kHead}) {
    const auto image = joint_way(out->motion, bone);
    const auto source = joint_way(state.motion, mirrored(bone));
    for (std::size_t t = 0; t < image.size(); ++t) {
      EXPECT_NEAR(image[t].x, -source[t].x, 1e-9);
      EXPECT_NEAR(image[t].y, source[t].y, 1e-9);
      EXPECT_NEAR(image[t].z, source[t].z, 1e-9);
    }
  }
  EXPECT_EQ(out->contacts.feet[0].stance.size(), state.contacts.feet[1].stance.size());
}

TEST(Mirror, ExchangesTheSidesOfNames) {
  EXPECT_EQ(mirrored_name("leftThumb1"), "rightThumb1");
  EXPECT_EQ(mirrored_name("RightArm"), "LeftArm");
  EXPECT_EQ(mirrored_name("thigh.L"), "thigh.R");
  EXPECT_EQ(mirrored_name("b_l_index"), "b_r_index");
  EXPECT_EQ(mirrored_name("pelvis"), "pelvis");
  EXPECT_EQ(mirrored_name("left.strike"), "right.strike");
}

TEST(Place, MovesTheHipsAndTheTravelAsRequested) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    PlaceOp place;
    place.position_xz_m = glm::dvec2(3.0, -2.0);
    place.heading_rad = 0.7;
    OpScene scene{place};
    const auto out = scene.run(apply_place, disturbed_walk(seed));
    ASSERT_TRUE(out);
    const auto way = joint_way(out->motion, HumanBone::kHips);
    EXPECT_NEAR(way.front().x, 3.0, 1e-9);
    EXPECT_NEAR(way.front().z, -2.0, 1e-9);
    const glm::dvec3 travel = way.back() - way.front();
    EXPECT_NEAR(std::atan2(travel.x, travel.z), 0.7, 1e-9);
  }
}

TEST(Place, WithoutAWishIsRefused) {
  OpScene scene{PlaceOp{}};
  EXPECT_FALSE(scene.run(apply_place, disturbed_walk(1)));
}

TEST(Retime, ShowsEachKnotAtItsTime) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> frames(20, 60);
    RetimeOp retime;
    int source = 0;
    int shown = 0;
    for (int i = 0; i < 3; ++i) {
      source += frames(random);
      shown += frames(random);
      retime.knots.push_back({AtFrame{static_cast<double>(source)}, shown / 120.0});
    }
    const EditState state = disturbed_walk(seed);
    OpScene scene{retime};
    const auto out = scene.run(apply_retime, state);
    ASSERT_TRUE(out) << out.error().message();
    for (const RetimeKnot& knot : retime.knots) {
      const auto at = static_cast<std::size_t>(std::lround(knot.time_s * 120.0));
      const auto from = static_cast<std::size_t>(std::get<AtFrame>(knot.at).frame);
      EXPECT_LT(glm::distance(out->motion.poses[at].root_in_world,
                              state.motion.poses[from].root_in_world),
                1e-9);
    }
  }
}

TEST(Retime, AtHalfTheSpeedKeepsEverySecondFrame) {
  const EditState state = disturbed_walk(7, 61, 60.0);
  RetimeOp retime;
  retime.speed = 0.5;
  OpScene scene{retime};
  const auto out = scene.run(apply_retime, state);
  ASSERT_TRUE(out);
  ASSERT_EQ(out->frame_count(), 121);
  for (std::size_t t = 0; t < 61; ++t) {
    EXPECT_EQ(out->motion.poses[2 * t].root_in_world,
              state.motion.poses[t].root_in_world);
  }
}

// A pure tone below half the old rate has no share above it when slowed down four times.
TEST(Retime, AddsNoFrequencyAboveHalfTheOldRate) {
  EditState state = disturbed_walk(8, 241, 60.0);
  for (std::size_t t = 0; t < 241; ++t) {
    state.motion.poses[t].root_in_world.x =
        std::sin(2.0 * std::numbers::pi * 6.0 * static_cast<double>(t) / 60.0);
  }
  RetimeOp retime;
  retime.speed = 0.25;
  OpScene scene{retime};
  const auto out = scene.run(apply_retime, state);
  ASSERT_TRUE(out);
  // Now a tone of 1.5 Hz; its images lie at 13.5 Hz and above.
  const auto share = [&](double hz) {
    double re = 0.0;
    double im = 0.0;
    const int from = 120;
    const int count = 720;
    for (int t = 0; t < count; ++t) {
      const double window = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * t / count);
      const double x =
          out->motion.poses[static_cast<std::size_t>(from + t)].root_in_world.x;
      re += window * x * std::cos(2.0 * std::numbers::pi * hz * t / 60.0);
      im += window * x * std::sin(2.0 * std::numbers::pi * hz * t / 60.0);
    }
    return std::hypot(re, im);
  };
  for (const double image_hz : {13.5, 16.5, 28.5}) {
    EXPECT_LT(share(image_hz), 3e-4 * share(1.5)) << image_hz;
  }
}

TEST(Retime, RefusesKnotsThatDoNotAscend) {
  RetimeOp retime;
  retime.knots = {{AtFrame{50}, 1.0}, {AtFrame{40}, 1.5}};
  OpScene scene{retime};
  const auto out = scene.run(apply_retime, disturbed_walk(1));
  ASSERT_FALSE(out);
  EXPECT_NE(out.error().cause.find("do not ascend"), std::string::npos);
}

TEST(Annotate, FindsAMarkedFrameAfterAChainOfOperations) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> frame_of(80, 160);
    const int marked = frame_of(random);
    EventOp event{"here", AtFrame{static_cast<double>(marked)}};
    OpScene scene{event};
    const EditState walk = disturbed_walk(seed);
    auto state = scene.run(apply_event, walk);
    ASSERT_TRUE(state);
    const glm::dvec3 place =
        joint_way(walk.motion, HumanBone::kHead)[static_cast<std::size_t>(marked)];
    OpScene cut{CutOp{}};
    cut.op.span = {AtFrame{30}, AtFrame{200}};
    state = cut.run(apply_cut, *state);
    RetimeOp slower;
    slower.speed = 0.5;
    OpScene retime{slower};
    state = retime.run(apply_retime, *state);
    OpScene mirror{MirrorOp{}};
    state = mirror.run(apply_mirror, *state);
    ASSERT_TRUE(state);
    const auto frame = resolve_moment(*state, AtAnnotation{"here", 0});
    ASSERT_TRUE(frame);
    EXPECT_NEAR(*frame, 2.0 * (marked - 30), 0.5);
    const glm::dvec3 found = joint_way(
        state->motion, HumanBone::kHead)[static_cast<std::size_t>(std::lround(*frame))];
    EXPECT_NEAR(found.z, place.z, 1e-9);
    EXPECT_NEAR(found.x, -place.x, 1e-9);
  }
}

TEST(Annotate, DrawsACurveThroughItsKeys) {
  CurveOp curve{"weight", {{AtFrame{0}, 0.0}, {AtFrame{100}, 1.0}}};
  OpScene scene{curve};
  const auto out = scene.run(apply_curve, disturbed_walk(1));
  ASSERT_TRUE(out);
  ASSERT_EQ(out->annotations.curves.size(), 1U);
  EXPECT_DOUBLE_EQ(out->annotations.curves[0].values[50], 0.5);
  EXPECT_DOUBLE_EQ(out->annotations.curves[0].values[200], 1.0);
}

TEST(Contacts, AreRemovedFromAClearedSpan) {
  ContactsOp contacts;
  for (const FootPart part : {FootPart::kHeel, FootPart::kBall}) {
    contacts.edits.push_back({ContactEdit::Kind::kClear, 0, part, 0.0, 1.99});
  }
  OpScene scene{contacts};
  const auto out = scene.run(
      apply_contacts, *make_edit_state(testing::synthetic_walk(240, 120.0).motion));
  ASSERT_TRUE(out);
  EXPECT_TRUE(out->contacts.feet[0].stance.empty());
  EXPECT_FALSE(out->contacts.feet[1].stance.empty());
}

TEST(Contacts, ReportsAnEditedContactInWhichTheFootMoves) {
  const EditState walk = *make_edit_state(testing::synthetic_walk(240, 120.0).motion);
  const FrameRange stance = walk.contacts.feet[0].heel.front();
  ContactsOp swing;  // Two seconds of steps.
  swing.edits = {{ContactEdit::Kind::kSet, 0, FootPart::kHeel, 0.0, 1.9}};
  OpScene moved{swing};
  ASSERT_TRUE(moved.run(apply_contacts, walk));
  EXPECT_TRUE(moved.has_finding("moving_contact"));
  ContactsOp same;
  same.edits = {{ContactEdit::Kind::kSet,
                 0,
                 FootPart::kHeel,
                 (stance.first + 2) / 120.0,
                 (stance.last - 2) / 120.0}};
  OpScene rests{same};
  ASSERT_TRUE(rests.run(apply_contacts, walk));
  EXPECT_FALSE(rests.has_finding("moving_contact"));
}

TEST(Plant, WithinASpanLeavesTheRestToTheBit) {
  const EditState state = disturbed_walk(9);
  OpScene scene{PlantOp{}};
  scene.op.span = {AtTime{0.8}, AtTime{1.2}};
  scene.op.blend_s = 0.1;
  const auto out = scene.run(apply_plant, state);
  ASSERT_TRUE(out);
  for (std::size_t t = 0; t < out->motion.poses.size(); ++t) {
    if (t >= 84 && t <= 156) continue;
    EXPECT_EQ(out->motion.poses[t].parent_from_joint,
              state.motion.poses[t].parent_from_joint);
  }
}

}  // namespace
}  // namespace marey::edit
