// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/feeds/live_groups.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/program/count_allocations.h"

namespace marey::capture {
namespace {

using std::chrono::milliseconds;

/// A camera on the real clock that may be slow or become silent.
class ClockFeed final : public FrameFeed {
 public:
  ClockFeed(milliseconds period, long frames) : period_(period), frames_(frames) {}

  std::optional<RawFrame> next(milliseconds timeout) override {
    if (frames_ >= 0 && next_ >= frames_) {
      std::this_thread::sleep_for(timeout);
      return std::nullopt;
    }
    std::this_thread::sleep_for(period_);
    RawFrame frame;
    frame.time = std::chrono::steady_clock::now().time_since_epoch();
    frame.sequence = static_cast<std::uint32_t>(next_++);
    return frame;
  }
  [[nodiscard]] const DeviceSettings& settings() const override { return settings_; }
  [[nodiscard]] std::string device() const override { return "clock"; }
  std::vector<FeedEvent> events() override { return {}; }

 private:
  milliseconds period_;
  long frames_;
  long next_ = 0;
  DeviceSettings settings_;
};

GroupFramesOptions live() {
  GroupFramesOptions options;
  options.mode = GroupingMode::kLive;
  options.rate = {100.0};
  options.origin = std::nullopt;
  options.max_wait = milliseconds(40);
  options.silent_after = milliseconds(150);
  options.capacity = 8;
  return options;
}

bool keep_sequence(CameraId /*camera*/, const RawFrame& frame, long& made) {
  made = static_cast<long>(frame.sequence);
  return true;
}

// Checks only results that do not depend on the speed of the machine.
TEST(LiveGroups, GoOnWithoutACameraThatIsSlowAndOneThatDied) {
  ClockFeed steady(milliseconds(10), -1);
  ClockFeed slow(milliseconds(55), -1);
  ClockFeed dying(milliseconds(10), 20);
  const std::array<FrameFeed*, 3> feeds{&steady, &slow, &dying};
  const std::vector<ClockModel> clocks(3);
  LiveGroups<long> groups(feeds, clocks, live(), keep_sequence);
  std::int64_t last = -1;
  std::array<long, 3> last_sequences{-1, -1, -1};
  int with_steady = 0;
  int with_slow = 0;
  int without_dead = 0;  // Over the last groups.
  while (with_steady < 60 || with_slow < 3 || without_dead < 30) {
    const LiveGroup<long>* group = groups.next(milliseconds(60000));
    ASSERT_NE(group, nullptr);
    EXPECT_GT(group->number, last);
    last = group->number;
    EXPECT_EQ(group->frames.size() + group->missing.size(), 3U);
    for (const LiveFrame<long>& frame : group->frames) {
      long& last_sequence = last_sequences[index(frame.camera)];
      EXPECT_GT(*frame.made, last_sequence) << "shown twice";
      last_sequence = *frame.made;
      with_steady += frame.camera == CameraId{0};
      with_slow += frame.camera == CameraId{1};
    }
    const bool is_missing = std::ranges::count(group->missing, CameraId{2}) == 1;
    without_dead = is_missing ? without_dead + 1 : 0;
  }
}

/// Counts its instances.
struct Counted {
  Counted() { ++count; }
  static inline int count = 0;
};

// The minimum: the frames that wait for their group, one in use, one being written.
TEST(LiveGroups, KeepTwoPlacesMoreThanFramesMayWait) {
  Counted::count = 0;
  ClockFeed left(milliseconds(1), -1);
  ClockFeed right(milliseconds(7), -1);
  const std::array<FrameFeed*, 2> feeds{&left, &right};
  const std::vector<ClockModel> clocks(2);
  LiveGroups<Counted> groups(
      feeds, clocks, live(), [](CameraId, const RawFrame&, Counted&) { return true; });
  EXPECT_EQ(Counted::count, 2 * (live().capacity + 2));
  for (int i = 0; i < 100; ++i) ASSERT_NE(groups.next(milliseconds(60000)), nullptr);
}

TEST(LiveGroups, GiveNothingWhenNothingComes) {
  ClockFeed silent(milliseconds(10), 0);
  const std::array<FrameFeed*, 1> feeds{&silent};
  const std::vector<ClockModel> clocks(1);
  LiveGroups<long> groups(feeds, clocks, live(), keep_sequence);
  EXPECT_EQ(groups.next(milliseconds(30)), nullptr);
}

TEST(LiveGroups, PassOverFramesThatAreNotWanted) {
  ClockFeed steady(milliseconds(2), -1);
  const std::array<FrameFeed*, 1> feeds{&steady};
  const std::vector<ClockModel> clocks(1);
  LiveGroups<long> groups(
      feeds, clocks, live(), [](CameraId, const RawFrame& frame, long& made) {
        made = static_cast<long>(frame.sequence);
        return made % 5 == 0;
      });
  for (int i = 0; i < 20; ++i) {
    const LiveGroup<long>* group = groups.next(milliseconds(60000));
    ASSERT_NE(group, nullptr);
    ASSERT_EQ(group->frames.size(), 1U);
    EXPECT_EQ(*group->frames[0].made % 5, 0);
  }
}

TEST(LiveGroups, AllocateNothingPerFrame) {
  ClockFeed left(milliseconds(1), -1);
  ClockFeed right(milliseconds(1), -1);
  const std::array<FrameFeed*, 2> feeds{&left, &right};
  const std::vector<ClockModel> clocks(2);
  LiveGroups<long> groups(feeds, clocks, live(), keep_sequence);
  for (int i = 0; i < 20; ++i) (void)groups.next(milliseconds(60000));
  const long before = testing::allocations();
  for (int i = 0; i < 200; ++i) (void)groups.next(milliseconds(60000));

  EXPECT_EQ(testing::allocations() - before, 0);
}

}  // namespace
}  // namespace marey::capture
