// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/record/frame_queue.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/program/count_allocations.h"

namespace marey::app {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kNow{0};

TEST(FrameQueue, RejectsFramesWhenFullAndLosesNoOthers) {
  FrameQueue queue(3, 1000);
  const std::array<std::byte, 4> bytes{std::byte{1}, std::byte{2}, std::byte{3}};
  recordings::TakeFrame stamp;
  for (unsigned k = 0; k < 3; ++k) {
    stamp.sequence = k;
    EXPECT_TRUE(queue.push(bytes, stamp));
  }
  EXPECT_FALSE(queue.push(bytes, stamp));
  EXPECT_EQ(queue.pop(kNow)->stamp.sequence, 0U);
  EXPECT_FALSE(queue.push(bytes, stamp));  // The first is in use and keeps its place.
  EXPECT_EQ(queue.pop(kNow)->stamp.sequence, 1U);
  stamp.sequence = 7;
  EXPECT_TRUE(queue.push(bytes, stamp));
  queue.close();
  EXPECT_EQ(queue.pop(kNow)->stamp.sequence, 2U);
  EXPECT_FALSE(queue.is_over());
  EXPECT_EQ(queue.pop(kNow)->stamp.sequence, 7U);
  EXPECT_TRUE(queue.is_over());
  EXPECT_EQ(queue.pop(kNow), nullptr);
}

TEST(FrameQueue, ReturnsNothingAfterATimeout) {
  FrameQueue queue(3, 1000);
  EXPECT_EQ(queue.pop(milliseconds(1)), nullptr);
  EXPECT_FALSE(queue.is_over());
}

TEST(FrameQueue, RejectsOnlyFramesLargerThanItsMemory) {
  FrameQueue queue(3, 1000);
  EXPECT_FALSE(queue.push(std::vector<std::byte>(1001), {}));
  EXPECT_TRUE(queue.push(std::vector<std::byte>(1000), {}));
  EXPECT_FALSE(queue.push(std::vector<std::byte>(1), {}));
  EXPECT_NE(queue.pop(kNow), nullptr);
  EXPECT_FALSE(queue.push(std::vector<std::byte>(1), {}));
  EXPECT_EQ(queue.pop(kNow), nullptr);
  EXPECT_TRUE(queue.push(std::vector<std::byte>(1), {}));
}

// Compares the queue with one without limits: frames of any sizes, pushed and popped in
// any order. Waiting frames are never overwritten. No frame is refused while two of the
// largest would fit.
TEST(FrameQueue, KeepsEveryByteOfFramesOfManySizes) {
  constexpr std::size_t kMemory = 1000;
  constexpr std::size_t kMaxBytes = 300;
  constexpr std::size_t kPlaces = 6;
  FrameQueue queue(kPlaces, kMemory);
  std::deque<std::vector<std::byte>> expected;
  std::size_t waiting = 0;
  std::mt19937 random(3);
  const QueuedFrame* lent = nullptr;
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    if (random() % 2 == 0) {
      std::vector<std::byte> bytes(1 + random() % kMaxBytes);
      for (std::byte& b : bytes) b = static_cast<std::byte>(random());
      const bool taken = queue.push(bytes, {});
      if (!taken) ++refused;
      const bool has_room =
          waiting + 2 * kMaxBytes <= kMemory && expected.size() < kPlaces;
      EXPECT_TRUE(taken || !has_room);
      if (!taken) continue;
      waiting += bytes.size();
      expected.push_back(std::move(bytes));
      continue;
    }
    if (lent != nullptr) {
      waiting -= expected.front().size();
      expected.pop_front();
    }
    lent = queue.pop(kNow);
    ASSERT_EQ(lent != nullptr, !expected.empty());
    if (lent == nullptr) continue;
    ASSERT_TRUE(std::equal(lent->bytes.begin(),
                           lent->bytes.end(),
                           expected.front().begin(),
                           expected.front().end()))
        << i;
  }
  EXPECT_GT(refused, 100);
}

TEST(FrameQueue, AllocatesNothing) {
  FrameQueue queue(4, 20000);
  const std::vector<std::byte> bytes(5000, std::byte{7});
  const long before = testing::allocations();
  for (int k = 0; k < 10000; ++k) {
    EXPECT_TRUE(queue.push(bytes, {}));
    EXPECT_NE(queue.pop(kNow), nullptr);
  }
  EXPECT_EQ(testing::allocations() - before, 0);
}

}  // namespace
}  // namespace marey::app
