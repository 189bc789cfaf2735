// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "edit/ops/splice.h"
#include <gtest/gtest.h>

#include "tests/edit/ops/splice_scene.h"

namespace marey::edit {
namespace {

TEST(Splice, AnotherConstraintOfTheSameIdGetsANewOne) {
  EditState first = walk_with_notes();
  first.constraints.constraints[0].activation.start_s = 0.2;
  first.constraints.constraints[0].activation.stop_s = 0.8;
  SpliceOp op;
  op.at = AtFrame{200};
  op.enter_at = AtFrame{90};
  auto scene = splice_scene(as_source(walk_with_notes(), {0, 329}, 1), op);
  const auto joined = scene.run(apply_splice, first);
  ASSERT_TRUE(joined);
  ASSERT_EQ(joined->constraints.constraints.size(), 2U);
  EXPECT_EQ(joined->constraints.constraints[0].id, "reach");
  EXPECT_EQ(joined->constraints.constraints[1].id, "reach.2");
}

TEST(Splice, GivenFramesOnOppositeFeetAreReported) {
  const EditState walk = splice_walk();
  SpliceOp op;
  op.at = AtFrame{200};
  op.enter_at = AtFrame{200.0 - kSpliceCycle / 2};
  auto scene = splice_scene(as_source(walk, {0, 329}, 1), op);
  bool reported = false;
  for (double shift = 0.0; shift < kSpliceCycle; shift += 10.0) {
    std::get<SpliceOp>(scene.op.parameters).at = AtFrame{150.0 + shift};
    std::get<SpliceOp>(scene.op.parameters).enter_at =
        AtFrame{150.0 + shift - kSpliceCycle / 2};
    ASSERT_TRUE(scene.run(apply_splice, walk));
    reported = reported || scene.has_finding("supports");
  }
  EXPECT_TRUE(reported);
}

TEST(Splice, JoinInsideAFlightIsReported) {
  EditState walk = splice_walk();
  for (FootContacts& foot : walk.contacts.feet) {
    for (auto* runs : {&foot.heel, &foot.ball, &foot.stance, &foot.heel_up}) {
      std::erase_if(*runs, [](const FrameRange& run) { return run.last > 120; });
    }
  }
  EditState next = as_source(walk, {0, 329}, 1);
  SpliceOp op;
  op.at = AtFrame{280};
  op.enter_at = AtFrame{170};
  auto scene = splice_scene(next, op);
  ASSERT_TRUE(scene.run(apply_splice, walk));
  EXPECT_TRUE(scene.has_finding("flight"));
}

void expect_declined(OpScene<SpliceOp> scene, const EditState& state, const char* text) {
  const auto made = scene.run(apply_splice, state);
  ASSERT_FALSE(made) << text;
  EXPECT_NE(made.error().message().find(text), std::string::npos)
      << made.error().message();
  EXPECT_EQ(made.error().code, Errc::kBadInput);
}

TEST(Splice, DeclinesWhatCannotBeDone) {
  const EditState walk = splice_walk();
  auto unknown = splice_scene(walk);
  std::get<SpliceOp>(unknown.op.parameters).source = "nexd";
  expect_declined(unknown, walk, "the recipe has no source \"nexd\"");
  expect_declined(unknown, walk, "perhaps you mean \"next\"");

  auto empty = splice_scene(walk);
  empty.op.span = {AtFrame{100.2}, AtFrame{100.8}};
  expect_declined(empty, walk, "contains no frame to leave at");

  auto twice = splice_scene(walk, {.at = AtFrame{100}});
  twice.op.span = {AtFrame{100.0}, AtFrame{110.0}};
  expect_declined(twice, walk, "together with at");

  auto groups = splice_scene(walk);
  groups.op.groups = {EditGroup::kHead};
  expect_declined(groups, walk, "groups");

  auto blend = splice_scene(walk);
  blend.op.blend_s = 0.2;
  expect_declined(blend, walk, "set overlap_s = 0");

  expect_declined(splice_scene(walk, {.overlap_s = -1.0}), walk, "overlap_s");
  expect_declined(splice_scene(walk, {.enter_at = AtFrame{1000}}), walk, "enter_at");
  expect_declined(splice_scene(walk, {.at = AtTime{90.0}}), walk, "");
}

TEST(Splice, SingleFramesCanBeJoined) {
  const EditState walk = splice_walk();
  for (const double overlap_s : {0.0, 0.3}) {
    SpliceOp op;
    op.overlap_s = overlap_s;
    auto scene = splice_scene(as_source(walk, {40, 40}, 1), op);
    const auto joined = scene.run(apply_splice, slice_state(walk, {150, 150}));
    ASSERT_TRUE(joined) << joined.error().message();
    EXPECT_EQ(joined->frame_count(), 1);
    auto onto = splice_scene(as_source(walk, {40, 40}, 1), op);
    const auto ended = onto.run(apply_splice, slice_state(walk, {0, 150}));
    ASSERT_TRUE(ended) << ended.error().message();
  }
}

}  // namespace
}  // namespace marey::edit
