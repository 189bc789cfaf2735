// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/sync/group_frames.h"

#include <algorithm>
#include <random>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/program/count_allocations.h"

namespace marey::capture {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr CameraId kLeft{0};
constexpr CameraId kRight{1};

Timestamp at_ms(double value) {
  return from_seconds(1e-3 * value);
}

/// A group as values.
struct Seen {
  std::int64_t number = 0;
  std::vector<std::tuple<int, std::int64_t, std::int64_t>>
      frames;  // Camera, time, ticket
  std::vector<int> missing;
  std::vector<std::int64_t> surplus;

  bool operator==(const Seen&) const = default;
};

Seen copy(const FrameGroup& group) {
  Seen seen;
  seen.number = group.number;
  for (const GroupedFrame& f : group.frames) {
    seen.frames.emplace_back(
        static_cast<int>(f.camera), f.time.count(), static_cast<std::int64_t>(f.ticket));
  }
  for (const CameraId camera : group.missing) {
    seen.missing.push_back(static_cast<int>(camera));
  }
  for (const GroupedFrame& f : group.surplus) {
    seen.surplus.push_back(static_cast<std::int64_t>(f.ticket));
  }
  return seen;
}

GroupFramesOptions live() {
  GroupFramesOptions options;
  options.mode = GroupingMode::kLive;
  options.rate = {100.0};  // A period is 10 ms.
  options.max_wait = milliseconds(15);
  options.silent_after = milliseconds(200);
  return options;
}

GroupFramesOptions offline() {
  GroupFramesOptions options;
  options.rate = {100.0};
  return options;
}

// --- Offline
// -----------------------------------------------------------------------------

struct Shot {
  Timestamp time{0};  ///< On the camera's own clock.
  FrameTicket ticket{};
};

/// Frames of four cameras with independent clocks at 200 instants: jitter of up to 4 of
/// 10 ms, one frame in ten dropped.
struct Shooting {
  std::vector<ClockModel> clocks;
  std::vector<std::vector<Shot>> cameras;
};

Shooting shoot(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter_ms(-4.0, 4.0);
  std::bernoulli_distribution dropped(0.1);
  Shooting all;
  std::int64_t ticket = 0;
  for (int c = 0; c < 4; ++c) {
    all.clocks.push_back({seconds(c * 100), 20.0 * c});
    std::vector<Shot>& shots = all.cameras.emplace_back();
    for (int k = 0; k < 200; ++k) {
      const Timestamp common = at_ms(10.0 * k + jitter_ms(random)) + seconds(1000);
      if (dropped(random)) continue;
      const double own =
          static_cast<double>((common - all.clocks.back().offset).count()) /
          (1.0 + 20e-6 * c);
      shots.push_back({Timestamp{std::llround(own)}, FrameTicket{ticket++}});
    }
  }
  return all;
}

/// Returns the groups of the recording for an order of arrivals between cameras drawn
/// from `seed`.
std::vector<Seen> group_in_any_order(const Shooting& all, unsigned seed, int capacity) {
  GroupFramesOptions options = offline();
  options.capacity = capacity;
  FrameGrouper grouper(all.clocks, options);
  std::mt19937 random(seed);
  std::vector<std::size_t> next(all.cameras.size(), 0);
  std::vector<bool> ended(all.cameras.size(), false);
  std::vector<Seen> seen;
  for (std::size_t left = all.cameras.size(); left > 0;) {
    const std::size_t c = random() % all.cameras.size();
    if (ended[c]) continue;
    const CameraId camera{static_cast<int>(c)};
    if (next[c] == all.cameras[c].size()) {
      grouper.end(camera);
      ended[c] = true;
      --left;
    } else {
      const Shot& shot = all.cameras[c][next[c]];
      if (!grouper.offer(camera, shot.time, shot.ticket).refused) ++next[c];
    }
    if (random() % 3 == 0) continue;  // The consumer is slow at times.
    while (const auto group = grouper.next()) seen.push_back(copy(*group));
  }
  while (const auto group = grouper.next()) seen.push_back(copy(*group));
  return seen;
}

TEST(GroupFramesOffline, GivesTheSameGroupsForAnyOrderOfArrival) {
  for (unsigned scene = 0; scene < 5; ++scene) {
    const Shooting all = shoot(scene);
    const std::vector<Seen> expected = group_in_any_order(all, 0, 64);
    for (unsigned order = 1; order < 40; ++order) {
      const int capacity = 2 + static_cast<int>(order % 9);
      ASSERT_EQ(group_in_any_order(all, order, capacity), expected)
          << "scene " << scene << ", order " << order;
    }
  }
}

TEST(GroupFramesOffline, HandsOutEveryFrameOnceAndAtItsInstant) {
  const Shooting all = shoot(7);
  std::size_t taken = 0;
  for (const auto& camera : all.cameras) taken += camera.size();
  std::vector<std::int64_t> tickets;
  for (const Seen& group : group_in_any_order(all, 3, 8)) {
    EXPECT_EQ(group.frames.size() + group.missing.size(), 4U);
    EXPECT_TRUE(group.surplus.empty());
    for (const auto& [camera, time, ticket] : group.frames) {
      tickets.push_back(ticket);
      // The jitter, and a microsecond for the rounding of the clocks.
      EXPECT_NEAR(
          static_cast<double>(time), 1e7 * static_cast<double>(group.number), 4.001e6);
    }
  }
  std::sort(tickets.begin(), tickets.end());
  EXPECT_EQ(std::unique(tickets.begin(), tickets.end()), tickets.end());
  EXPECT_EQ(tickets.size(), taken);
}

TEST(GroupFramesOffline, ReportsTheMissingCamerasOfEachGroup) {
  const std::vector<ClockModel> clocks(2);
  FrameGrouper grouper(clocks, offline());
  for (const double t : {0.0, 10.0, 30.0}) grouper.offer(kLeft, at_ms(t), FrameTicket{0});
  for (const double t : {0.0, 20.0, 31.0})
    grouper.offer(kRight, at_ms(t), FrameTicket{0});
  grouper.end(kLeft);
  grouper.end(kRight);
  std::vector<std::vector<int>> missing;
  while (const auto group = grouper.next()) missing.push_back(copy(*group).missing);
  EXPECT_EQ(missing, (std::vector<std::vector<int>>{{}, {1}, {0}, {}}));
  EXPECT_EQ(grouper.counts(kLeft).missing, 1);
  EXPECT_EQ(grouper.counts(kRight).missing, 1);
}

TEST(GroupFramesOffline, HandsASecondFrameOfAnInstantOutAsSurplus) {
  const std::vector<ClockModel> clocks(1);
  FrameGrouper grouper(clocks, offline());
  grouper.offer(kLeft, at_ms(-2), FrameTicket{1});
  grouper.offer(kLeft, at_ms(3), FrameTicket{2});
  grouper.offer(kLeft, at_ms(-5), FrameTicket{3});  // Its clock jumped back.
  grouper.offer(kLeft, at_ms(11), FrameTicket{4});
  grouper.end(kLeft);
  const auto group = grouper.next();
  ASSERT_TRUE(group);
  EXPECT_EQ(copy(*group).frames.size(), 1U);
  EXPECT_EQ(copy(*group).surplus, (std::vector<std::int64_t>{2, 3}));
  EXPECT_EQ(grouper.counts(kLeft).surplus, 2);
}

TEST(GroupFramesOffline, WaitsForASlowCameraAndRefusesWhatHasNoRoom) {
  GroupFramesOptions options = offline();
  options.capacity = 3;
  const std::vector<ClockModel> clocks(2);
  FrameGrouper grouper(clocks, options);
  for (int k = 0; k < 3; ++k) {
    EXPECT_FALSE(grouper.offer(kLeft, at_ms(10.0 * k), FrameTicket{k}).refused);
  }
  EXPECT_TRUE(grouper.offer(kLeft, at_ms(30), FrameTicket{3}).refused);
  EXPECT_FALSE(grouper.next(seconds(1000)));
  grouper.end(kRight);
  EXPECT_TRUE(grouper.next());
  EXPECT_FALSE(grouper.offer(kLeft, at_ms(30), FrameTicket{3}).refused);
  EXPECT_EQ(grouper.counts(kLeft).offered, 4);
}

// --- Live
// --------------------------------------------------------------------------------

TEST(GroupFramesLive, IsReadyAsSoonAsEveryCameraHasDelivered) {
  const std::vector<ClockModel> clocks(2);
  FrameGrouper grouper(clocks, live());
  grouper.offer(kLeft, at_ms(0), FrameTicket{1});
  EXPECT_FALSE(grouper.next(at_ms(3)));
  EXPECT_EQ(grouper.deadline(), at_ms(15));
  grouper.offer(kRight, at_ms(2), FrameTicket{2});
  const auto group = grouper.next(at_ms(3));
  ASSERT_TRUE(group);
  EXPECT_EQ(group->frames.size(), 2U);
  EXPECT_FALSE(grouper.deadline());
}

TEST(GroupFramesLive, WaitsNoLongerThanItMay) {
  const std::vector<ClockModel> clocks(2);
  FrameGrouper grouper(clocks, live());
  grouper.offer(kLeft, at_ms(0), FrameTicket{1});
  EXPECT_FALSE(grouper.next(at_ms(14.9)));
  const auto group = grouper.next(at_ms(15));
  ASSERT_TRUE(group);
  EXPECT_EQ(copy(*group).missing, std::vector<int>{1});
  const Offer late = grouper.offer(kRight, at_ms(1), FrameTicket{2});
  EXPECT_EQ(late.dropped, FrameTicket{2});
  EXPECT_EQ(grouper.counts(kRight).late, 1);
}

TEST(GroupFramesLive, DoesNotWaitForAFrameThatWasPassedOver) {
  const std::vector<ClockModel> clocks(2);
  FrameGrouper grouper(clocks, live());
  grouper.pass_over(kRight, at_ms(0));  // Before any other.
  grouper.offer(kLeft, at_ms(0), FrameTicket{1});
  grouper.offer(kRight, at_ms(10), FrameTicket{2});
  const auto first = grouper.next(at_ms(11));
  ASSERT_TRUE(first);
  EXPECT_EQ(copy(*first).missing, std::vector<int>{1});
  grouper.offer(kLeft, at_ms(10), FrameTicket{3});
  ASSERT_TRUE(grouper.next(at_ms(12)));

  grouper.offer(kLeft, at_ms(20), FrameTicket{4});
  EXPECT_FALSE(grouper.next(at_ms(21)));
  grouper.pass_over(kRight, at_ms(20.5));
  const auto third = grouper.next(at_ms(21));
  ASSERT_TRUE(third);
  EXPECT_EQ(third->number, 2);
  EXPECT_EQ(copy(*third).missing, std::vector<int>{1});
  // It returns with its next frame, and nothing was counted as offered.
  grouper.offer(kLeft, at_ms(30), FrameTicket{5});
  EXPECT_FALSE(grouper.next(at_ms(31)));
  grouper.offer(kRight, at_ms(30), FrameTicket{6});
  const auto fourth = grouper.next(at_ms(31));
  ASSERT_TRUE(fourth);
  EXPECT_EQ(fourth->frames.size(), 2U);
  EXPECT_EQ(grouper.counts(kRight).offered, 2);
}

TEST(GroupFramesLive, DoesNotWaitForACameraThatDied) {
  const std::vector<ClockModel> clocks(2);
  FrameGrouper grouper(clocks, live());
  std::vector<double> delays_ms;
  for (int k = 0; k < 100; ++k) {
    const double now = 10.0 * k;
    grouper.offer(kLeft, at_ms(now), FrameTicket{k});
    if (k < 20) grouper.offer(kRight, at_ms(now), FrameTicket{k});
    double waited = 0.0;
    while (!grouper.next(at_ms(now + waited)) && waited < 9.9) waited += 0.1;
    delays_ms.push_back(waited);
  }
  // Silent for 200 ms at frame 40: after that, it causes no delay.
  for (int k = 41; k < 100; ++k) EXPECT_EQ(delays_ms[static_cast<std::size_t>(k)], 0.0);
  EXPECT_GE(grouper.counts(kLeft).grouped, 90);
}

TEST(GroupFramesLive, TheNewestGroupWinsWhenTheConsumerIsSlow) {
  const std::vector<ClockModel> clocks(2);
  FrameGrouper grouper(clocks, live());
  for (int k = 0; k < 5; ++k) {
    grouper.offer(kLeft, at_ms(10.0 * k), FrameTicket{k});
    grouper.offer(kRight, at_ms(10.0 * k + 1), FrameTicket{10 + k});
  }
  const auto group = grouper.next(at_ms(45));
  ASSERT_TRUE(group);
  EXPECT_EQ(group->number, 4);
  EXPECT_EQ(copy(*group).surplus,
            (std::vector<std::int64_t>{0, 1, 2, 3, 10, 11, 12, 13}));
  EXPECT_EQ(grouper.skipped_groups(), 4);
  EXPECT_FALSE(grouper.next(at_ms(45)));
}

TEST(GroupFramesLive, ReplacesTheOldestFrameWhenTheQueueIsFull) {
  GroupFramesOptions options = live();
  options.capacity = 3;
  const std::vector<ClockModel> clocks(1);
  FrameGrouper grouper(clocks, options);
  for (int k = 0; k < 3; ++k) {
    EXPECT_FALSE(grouper.offer(kLeft, at_ms(10.0 * k), FrameTicket{k}).dropped);
  }
  EXPECT_EQ(grouper.offer(kLeft, at_ms(30), FrameTicket{3}).dropped, FrameTicket{0});
  EXPECT_EQ(grouper.counts(kLeft).displaced, 1);
}

// A camera whose frames arrive midway between two instants, with jitter.
TEST(GroupFramesLive, JitterBetweenTwoInstantsLosesNoFrame) {
  const std::vector<ClockModel> clocks(2);
  FrameGrouper grouper(clocks, live());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> jitter_ms(-2.0, 2.0);
  for (int k = 0; k < 500; ++k) {
    grouper.offer(kLeft, at_ms(10.0 * k), FrameTicket{k});
    grouper.offer(kRight, at_ms(10.0 * k + 5.0 + jitter_ms(random)), FrameTicket{k});
    while (grouper.next(at_ms(10.0 * k + 8.0))) {
    }
  }
  // The first frames may fall to either side.
  EXPECT_LE(grouper.counts(kRight).displaced + grouper.counts(kRight).late, 2);
  EXPECT_GE(grouper.counts(kRight).grouped, 495);
}

TEST(GroupFramesLive, CountsAddUpUnderAnyTreatment) {
  const std::vector<ClockModel> clocks(3);
  GroupFramesOptions options = live();
  options.capacity = 4;
  FrameGrouper grouper(clocks, options);
  std::mt19937 random(11);
  long handed_back = 0;
  long grouped = 0;
  long surplus = 0;
  for (int step = 0; step < 20000; ++step) {
    const CameraId camera{static_cast<int>(random() % 3)};
    const double t = step * 3.0 + static_cast<double>(random() % 30);
    if (grouper.offer(camera, at_ms(t), FrameTicket{step}).dropped) ++handed_back;
    if (random() % 4 != 0) continue;
    while (const auto group = grouper.next(at_ms(step * 3.0))) {
      grouped += static_cast<long>(group->frames.size());
      surplus += static_cast<long>(group->surplus.size());
    }
  }
  for (int c = 0; c < 3; ++c) grouper.end(CameraId{c});
  while (const auto group = grouper.next(seconds(1000))) {
    grouped += static_cast<long>(group->frames.size());
    surplus += static_cast<long>(group->surplus.size());
  }
  GroupingCounts sum;
  for (int c = 0; c < 3; ++c) {
    const GroupingCounts& counts = grouper.counts(CameraId{c});
    sum.offered += counts.offered;
    sum.grouped += counts.grouped;
    sum.late += counts.late;
    sum.displaced += counts.displaced;
    sum.surplus += counts.surplus;
  }
  EXPECT_EQ(sum.offered, 20000);
  EXPECT_EQ(sum.grouped, grouped);
  EXPECT_EQ(sum.surplus, surplus);
  EXPECT_EQ(sum.late + sum.displaced, handed_back);
  EXPECT_EQ(sum.offered, sum.grouped + sum.late + sum.displaced + sum.surplus);
}

// --- Memory
// ------------------------------------------------------------------------------

long allocations_of(const GroupFramesOptions& options) {
  const std::vector<ClockModel> clocks(4);
  FrameGrouper grouper(clocks, options);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> jitter_ms(-6.0, 6.0);
  const long before = testing::allocations();
  for (int k = 0; k < 10000; ++k) {
    for (int c = 0; c < 4; ++c) {
      if (random() % 50 == 0) continue;
      (void)grouper.offer(
          CameraId{c}, at_ms(10.0 * k + 2.0 * c + jitter_ms(random)), FrameTicket{k});
    }
    if (random() % 5 == 0) continue;
    while (grouper.next(at_ms(10.0 * k))) {
    }
  }
  return testing::allocations() - before;
}

TEST(GroupFrames, AllocatesNothingIn10000Frames) {
  EXPECT_EQ(allocations_of(live()), 0);
  EXPECT_EQ(allocations_of(offline()), 0);
}

}  // namespace
}  // namespace marey::capture
