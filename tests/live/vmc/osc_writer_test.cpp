// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/osc_writer.h"

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>
#include <lo/lo.h>

namespace marey::live {
namespace {

std::string text_of_packet(std::span<const std::uint8_t> packet) {
  return {packet.begin(), packet.end()};
}

using namespace std::string_literals;

// Put together by hand from the OSC 1.0 specification.
TEST(OscWriter, WritesTheBytesOfAHandMadeBundle) {
  OscWriter writer;
  writer.begin("/VMC/Ext/OK", "ii").add(1).add(-2);
  writer.begin("/ab", "sf").add("root").add(1.5F);
  const auto packets = writer.packets();
  ASSERT_EQ(packets.size(), 1U);
  EXPECT_EQ(text_of_packet(packets[0]),
            "#bundle\0"
            "\0\0\0\0\0\0\0\1"
            "\0\0\0\x18"
            "/VMC/Ext/OK\0"
            ",ii\0"
            "\0\0\0\1"
            "\xff\xff\xff\xfe"
            "\0\0\0\x14"
            "/ab\0"
            ",sf\0"
            "root\0\0\0\0"
            "\x3f\xc0\0\0"s);
}

TEST(OscWriter, WritesTheBytesThatLibloWrites) {
  const lo_bundle bundle = lo_bundle_new(LO_TT_IMMEDIATE);
  const lo_message first = lo_message_new();
  lo_message_add_string(first, "RightMiddleIntermediate");
  lo_message_add_float(first, -0.0F);
  lo_bundle_add_message(bundle, "/VMC/Ext/Bone/Pos", first);
  const lo_message second = lo_message_new();
  lo_bundle_add_message(bundle, "/VMC/Ext/Blend/Apply", second);
  std::size_t size = 0;
  auto* expected = static_cast<char*>(lo_bundle_serialise(bundle, nullptr, &size));

  OscWriter writer;
  writer.begin("/VMC/Ext/Bone/Pos", "sf").add("RightMiddleIntermediate").add(-0.0F);
  writer.begin("/VMC/Ext/Blend/Apply", "");
  EXPECT_EQ(text_of_packet(writer.packets()[0]), std::string(expected, size));
  std::free(expected);
  lo_bundle_free_recursive(bundle);
}

TEST(OscWriter, SplitsAtTheLimitBetweenMessages) {
  OscWriter writer(48);
  for (const int number : {1, 2, 3}) writer.begin("/abc", "i").add(number);
  // A bundle's head is 16 bytes, each message takes 4 + 8 + 4 + 4.
  const auto packets = writer.packets();
  ASSERT_EQ(packets.size(), 3U);
  for (const auto packet : packets) {
    EXPECT_EQ(packet.size(), 36U);
    EXPECT_EQ(text_of_packet(packet.first(8)), "#bundle\0"s);
  }
  EXPECT_EQ(packets[2].back(), 3);
}

TEST(OscWriter, EndsTextAtAZeroByte) {
  OscWriter writer;
  writer.begin("/a", "s").add(std::string_view("ab\0cd", 5));
  OscWriter shorter;
  shorter.begin("/a", "s").add("ab");
  EXPECT_EQ(text_of_packet(writer.packets()[0]), text_of_packet(shorter.packets()[0]));
}

TEST(OscWriter, HasNothingToSendAfterClear) {
  OscWriter writer;
  EXPECT_TRUE(writer.packets().empty());
  writer.begin("/a", "");
  writer.clear();
  EXPECT_TRUE(writer.packets().empty());
}

}  // namespace
}  // namespace marey::live
