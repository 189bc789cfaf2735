// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/web/newest_messages.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "live/vmc/message_rate.h"
#include "tests/support/program/count_allocations.h"

namespace marey::live {
namespace {

constexpr std::size_t kScene = index(MessageSlot::kScene);
constexpr std::size_t kFrame = index(MessageSlot::kFrame);
constexpr std::size_t kStatus = index(MessageSlot::kStatus);
constexpr std::size_t kThumbnail = index(MessageSlot::kThumbnail);

std::vector<std::string> all(const NewestMessages& messages,
                             NewestMessages::Reader& reader) {
  std::vector<std::string> out;
  std::string message;
  bool is_binary = false;
  while (messages.take(reader, message, is_binary)) out.push_back(message);
  return out;
}

using Texts = std::vector<std::string>;

TEST(NewestMessages, AreHadOnceByEachReader) {
  NewestMessages messages;
  messages.put(kStatus, "status");
  messages.put(kScene, "scene");
  NewestMessages::Reader early;
  EXPECT_EQ(all(messages, early), (Texts{"scene", "status"}));
  EXPECT_EQ(all(messages, early), Texts{});
  messages.put(kStatus, "status 2");
  NewestMessages::Reader late;
  EXPECT_EQ(all(messages, early), Texts{"status 2"});
  EXPECT_EQ(all(messages, late), (Texts{"scene", "status 2"}));
}

TEST(NewestMessages, ReplaceUnreadMessages) {
  NewestMessages messages;
  NewestMessages::Reader reader;
  for (int i = 0; i < 10; ++i) messages.put(kFrame, std::to_string(i));
  EXPECT_EQ(all(messages, reader), Texts{"9"});
  messages.put(kFrame, "10");
  messages.clear(kFrame);
  EXPECT_EQ(all(messages, reader), Texts{});
}

// However often frames come, pictures get through, and the other way round.
TEST(NewestMessages, TakeTurnsWithFrames) {
  NewestMessages messages;
  NewestMessages::Reader reader;
  std::string message;
  bool is_binary = false;
  Texts got;
  for (int i = 0; i < 6; ++i) {
    messages.put(kFrame, "frame");
    messages.put(kThumbnail, "a");
    messages.put(kThumbnail + 1, "b");
    ASSERT_TRUE(messages.take(reader, message, is_binary));
    EXPECT_TRUE(is_binary);
    got.push_back(message);
  }
  EXPECT_EQ(got, (Texts{"frame", "a", "frame", "a", "frame", "a"}));
  // The message with the longest waiting time is next.
  messages.put(kThumbnail, "a");
  EXPECT_EQ(all(messages, reader), (Texts{"frame", "b", "a"}));
}

TEST(NewestMessages, AllocateNothingOnceTheyHaveGrown) {
  NewestMessages messages;
  NewestMessages::Reader reader;
  const std::string large(1000, 'x');
  std::string out;
  bool is_binary = false;
  messages.put(kFrame, large);
  ASSERT_TRUE(messages.take(reader, out, is_binary));
  const long before = testing::allocations();
  for (int i = 0; i < 10; ++i) {
    messages.put(kFrame, large);
    ASSERT_TRUE(messages.take(reader, out, is_binary));
  }
  EXPECT_EQ(testing::allocations(), before);
}

TEST(MessageRate, AllowsSoManyASecond) {
  MessageRate rate(3);
  const MessageRate::Clock::time_point start{std::chrono::hours(1)};
  const auto at = [&](int ms) { return start + std::chrono::milliseconds(ms); };
  EXPECT_TRUE(rate.allow(at(0)) && rate.allow(at(10)) && rate.allow(at(999)));
  EXPECT_FALSE(rate.allow(at(999)));
  EXPECT_TRUE(rate.allow(at(1000)));
}

}  // namespace
}  // namespace marey::live
