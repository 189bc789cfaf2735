// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_balance.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "core/humanoid.h"
#include "retarget/body/place_masses.h"
#include "retarget/contacts/detect_contacts.h"
#include "retarget/contacts/frame_marks.h"
#include "tests/support/program/count_allocations.h"
#include "tests/support/simulation/synthetic_walk.h"

namespace marey::app {
namespace {

using retarget::BalanceFrame;

constexpr int kBalanceFrames = 200;
constexpr double kBalanceRate_hz = 60.0;

/// A walk, and its balance as `marey view` computes it from a recording.
class BalanceOfAWalk : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto map = retarget::map_body(walk_.skeleton);
    ASSERT_TRUE(map);
    const auto masses = retarget::place_masses(walk_.skeleton, *map, {});
    ASSERT_TRUE(masses);
    contacts_ = retarget::detect_contacts(walk_, *map);
    recorded_ = retarget::balance_frames(walk_, *map, *masses, contacts_);
  }

  [[nodiscard]] bool stands_as_recorded(const LiveBalance& live,
                                        std::size_t frame) const {
    for (std::size_t side = 0; side < 2; ++side) {
      const auto& foot = contacts_.feet[side];
      const auto heel = retarget::frame_marks(foot.heel, walk_.poses.size());
      const auto ball = retarget::frame_marks(foot.ball, walk_.poses.size());
      const retarget::StandingFoot& now = live.standing()[side];
      if (now.heel != (heel[frame] != 0) || now.ball != (ball[frame] != 0)) return false;
    }
    return true;
  }

  Motion walk_ =
      testing::synthetic_walk(kBalanceFrames, kBalanceRate_hz, 0.002, 0.001).motion;
  Contacts contacts_;
  std::vector<BalanceFrame> recorded_;
};

// To the bit, but for the moments at which live a foot is known to stand or leave later.
TEST_F(BalanceOfAWalk, MatchesTheRecording) {
  const std::array<const Skeleton*, 1> bodies{&walk_.skeleton};
  LiveBalance live(bodies);
  int alike = 0;
  int borne = 0;
  for (std::size_t i = 0; i < walk_.poses.size(); ++i) {
    live.step(walk_.poses[i], 1.0 / kBalanceRate_hz);
    const BalanceFrame* now = live.measure(0, walk_.poses[i]);
    ASSERT_NE(now, nullptr);
    EXPECT_EQ(now->centre_of_mass_in_world, recorded_[i].centre_of_mass_in_world) << i;
    borne += now->support_xz_m.empty() ? 0 : 1;
    if (!stands_as_recorded(live, i)) continue;
    ++alike;
    EXPECT_EQ(now->support_xz_m, recorded_[i].support_xz_m) << i;
  }
  EXPECT_GT(alike, kBalanceFrames * 3 / 4);
  EXPECT_GT(borne, kBalanceFrames * 9 / 10);
}

TEST_F(BalanceOfAWalk, TakesNoWeightOnAFootThatIsDragged) {
  const std::array<const Skeleton*, 2> bodies{&walk_.skeleton, &walk_.skeleton};
  LiveBalance live(bodies);
  const Pose rest = rest_pose(walk_.skeleton);
  for (int i = 0; i < 3; ++i) live.step(rest, 1.0 / kBalanceRate_hz);
  ASSERT_TRUE(live.standing()[0].heel && live.standing()[1].heel);
  const auto both = live.measure(1, rest)->support_xz_m;
  std::array<HandleState, 1> handles{};
  handles[0].joint = *walk_.skeleton.find(HumanBone::kLeftFoot);
  EXPECT_EQ(live.measure(1, rest, handles)->support_xz_m, both);
  handles[0].active = true;
  const auto& one = live.measure(1, rest, handles)->support_xz_m;
  ASSERT_EQ(one.size(), 4U);
  for (const glm::dvec2& corner : one) EXPECT_LT(corner.x, 0.0);  // The right foot's.
}

TEST_F(BalanceOfAWalk, AllocatesNothingOnceItHasLooked) {
  const std::array<const Skeleton*, 1> bodies{&walk_.skeleton};
  LiveBalance live(bodies);
  live.step(walk_.poses[0], 1.0 / kBalanceRate_hz);
  (void)live.measure(0, walk_.poses[0]);
  const long before = testing::allocations();
  for (const Pose& pose : walk_.poses) {
    live.step(pose, 1.0 / kBalanceRate_hz);
    (void)live.measure(0, pose);
  }
  EXPECT_EQ(testing::allocations(), before);
}

TEST(LiveBalance, IsAbsentForBodiesThatAreNotHuman) {
  Skeleton box;
  box.joints.push_back({});
  const std::array<const Skeleton*, 1> bodies{&box};
  LiveBalance live(bodies);
  live.step(rest_pose(box), 0.1);
  EXPECT_EQ(live.measure(0, rest_pose(box)), nullptr);
}

}  // namespace
}  // namespace marey::app
