// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "edit/splice/splice_contacts.h"

#include <vector>

#include <gtest/gtest.h>

namespace marey::edit {
namespace {

// Left foot of a motion of 100 frames at 100 Hz whose heel and ball have these contacts.
Contacts left_foot(std::vector<FrameRange> heel,
                   std::vector<FrameRange> ball,
                   std::vector<FrameRange> heel_up = {}) {
  Contacts out;
  out.frame_count = 100;
  FootContacts& foot = out.feet[0];
  foot.stance = ball;
  foot.heel = std::move(heel);
  foot.ball = std::move(ball);
  foot.heel_up = std::move(heel_up);
  return out;
}

// Both motions are shown in all frames; the join is in the middle.
constexpr JoinedFrames kFrames{0, 50, 99, 100.0};

JoinedFrames late_overlap() {
  JoinedFrames frames = kFrames;
  frames.start = 35;
  frames.length = 30;
  return frames;
}

void expect_runs(const std::vector<FrameRange>& runs,
                 const std::vector<FrameRange>& expected) {
  ASSERT_EQ(runs.size(), expected.size());
  for (std::size_t k = 0; k < runs.size(); ++k) {
    EXPECT_EQ(runs[k].first, expected[k].first);
    EXPECT_EQ(runs[k].last, expected[k].last);
  }
}

TEST(SpliceContacts, ContactOfBothMotionsIsOneContact) {
  const auto foot = left_foot({{20, 60}}, {{20, 70}});
  const auto joined = join_contacts(foot, foot, kFrames);
  EXPECT_EQ(joined.frame_count, 100);
  expect_runs(joined.feet[0].heel, {{20, 60}});
  expect_runs(joined.feet[0].stance, {{20, 70}});
  EXPECT_TRUE(joined.feet[1].stance.empty());
}

TEST(SpliceContacts, ContactThatTheJoinCutsShortLastsItsMinimum) {
  const auto joined =
      join_contacts(left_foot({}, {{48, 80}}), left_foot({}, {}), kFrames);
  expect_runs(joined.feet[0].ball, {{48, 53}});
}

TEST(SpliceContacts, ContactThatEndsSoonInItsOwnMotionIsDropped) {
  const auto joined =
      join_contacts(left_foot({}, {{48, 51}}), left_foot({}, {}), kFrames);
  EXPECT_TRUE(joined.feet[0].ball.empty());
}

TEST(SpliceContacts, ShortGapAtTheJoinIsClosed) {
  const auto joined =
      join_contacts(left_foot({}, {{20, 49}}), left_foot({}, {{52, 80}}), kFrames);
  expect_runs(joined.feet[0].stance, {{20, 80}});
}

// A flat foot becomes one that stands on its ball with the heel raised.
TEST(SpliceContacts, HeelIsNotStillWhileItRises) {
  const auto flat = left_foot({{0, 99}}, {{0, 99}});
  auto raised = left_foot({}, {{0, 64}}, {{0, 64}});
  raised.frame_count = 65;
  const auto joined = join_contacts(flat, raised, late_overlap());
  expect_runs(joined.feet[0].heel, {{0, 50}});
  expect_runs(joined.feet[0].stance, {{0, 99}});
  expect_runs(joined.feet[0].heel_up, {{66, 99}});
}

TEST(SpliceContacts, HeelThatIsRaisedInBothMotionsStaysStill) {
  const auto raised = left_foot({}, {{0, 99}}, {{0, 99}});
  const auto joined = join_contacts(raised, raised, kFrames);
  expect_runs(joined.feet[0].heel_up, {{0, 99}});
}

}  // namespace
}  // namespace marey::edit
