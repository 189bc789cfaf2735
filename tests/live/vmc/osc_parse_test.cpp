// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/osc_parse.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <lo/lo.h>

#include "tests/support/program/count_allocations.h"

namespace marey::live {
namespace {

using namespace std::string_literals;

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

const std::string kHead = "#bundle\0\0\0\0\0\0\0\0\1"s;

std::string sized(const std::string& element) {
  const auto size = static_cast<char>(element.size());
  return "\0\0\0"s + size + element;
}

TEST(OscParse, ReadsWhatLibloWrites) {
  const lo_message message = lo_message_new();
  lo_message_add_string(message, "Hips");
  lo_message_add_int32(message, -7);
  lo_message_add_float(message, 1.25F);
  lo_message_add_double(message, -2.5);
  lo_message_add_int64(message, 1LL << 40);
  lo_message_add_true(message);
  const lo_bundle inner = lo_bundle_new(LO_TT_IMMEDIATE);
  lo_bundle_add_message(inner, "/inner", message);
  const lo_bundle outer = lo_bundle_new(LO_TT_IMMEDIATE);
  lo_bundle_add_bundle(outer, inner);
  std::size_t size = 0;
  auto* data = static_cast<char*>(lo_bundle_serialise(outer, nullptr, &size));
  const std::string packet(data, size);
  std::free(data);
  lo_bundle_free_recursive(outer);

  int messages = 0;
  ASSERT_TRUE(parse_osc(bytes_of(packet), [&](const OscMessage& read) {
    ++messages;
    EXPECT_EQ(read.address, "/inner");
    OscArguments arguments = read.arguments();
    EXPECT_EQ(arguments.read_int(), std::nullopt);
    EXPECT_EQ(arguments.read_text(), "Hips");
    EXPECT_EQ(arguments.read_int(), -7);
    EXPECT_EQ(arguments.read_number(), 1.25);
    EXPECT_EQ(arguments.read_number(), -2.5);
    EXPECT_EQ(arguments.read_number(), std::ldexp(1.0, 40));
    EXPECT_EQ(arguments.read_number(), std::nullopt);
    EXPECT_FALSE(arguments.is_empty());
  }));
  EXPECT_EQ(messages, 1);
}

TEST(OscParse, TakesAMessageWithoutTypesAndAnEmptyBundle) {
  EXPECT_TRUE(is_osc(bytes_of("/ab\0"s)));
  EXPECT_TRUE(is_osc(bytes_of(kHead)));
}

TEST(OscParse, SkipsArgumentsOfEveryType) {
  const std::string message = "/a\0\0,ifsbhtdScrmTFNI[]\0\0"s + "\0\0\0\1"s +
                              "\0\0\0\0"s + "ab\0\0"s + "\0\0\0\2xy\0\0"s +
                              std::string(24, '\0') + "cde\0"s + std::string(12, '\0');
  EXPECT_TRUE(is_osc(bytes_of(message)));
}

TEST(OscParse, DeclinesNonFiniteNumbers) {
  for (const std::string& word : {"\x7f\x80\0\0"s, "\xff\x80\0\0"s, "\x7f\xc0\0\0"s}) {
    ASSERT_TRUE(parse_osc(bytes_of("/a\0\0,f\0\0"s + word), [](const OscMessage& m) {
      EXPECT_EQ(m.arguments().read_number(), std::nullopt);
    }));
  }
}

struct Broken {
  const char* what;
  std::string packet;
};

const std::vector<Broken>& broken() {
  static const std::string sound = "/ab\0,i\0\0\0\0\0\1"s;
  static const std::vector<Broken> list{
      {"nothing", ""s},
      {"text", "hello world!"s},
      {"an address without an end", "/abc"s},
      {"an address without padding", "/ab\0x"s},
      {"padding that is not zero", "/a\0x,i\0\0\0\0\0\1"s},
      {"an address without a slash", "ab\0\0,\0\0\0"s},
      {"types without a comma", "/ab\0i\0\0\0\0\0\0\1"s},
      {"types without an end", "/ab\0,iii"s},
      {"an unknown type", "/ab\0,q\0\0\0\0\0\1"s},
      {"too few arguments", "/ab\0,ii\0\0\0\0\1"s},
      {"too many bytes", sound + "\0\0\0\0"s},
      {"a text without an end", "/ab\0,s\0\0abcd"s},
      {"a blob longer than the packet", "/ab\0,b\0\0\0\0\0\5abcd"s},
      {"a blob as long as all memory", "/ab\0,b\0\0\xff\xff\xff\xff"s},
      {"a blob without its padding", "/ab\0,b\0\0\0\0\0\3abc"s},
      {"half a bundle's head", "#bundle\0\0\0\0\0"s},
      {"a bundle with half a size", kHead + "\0\0"s},
      {"a bundle with an empty element", kHead + "\0\0\0\0"s},
      {"an element longer than the packet", kHead + "\0\0\0\x10"s + sound},
      {"an element as long as all memory", kHead + "\xff\xff\xff\xfc"s + sound},
      {"an element of odd size", kHead + "\0\0\0\x0b"s + sound},
      {"a broken element after a sound one", kHead + sized(sound) + sized("abcd"s)},
  };
  return list;
}

TEST(OscParse, RejectsTheWholeOfAnyBrokenPacket) {
  for (const auto& [what, packet] : broken()) {
    int taken = 0;
    EXPECT_FALSE(parse_osc(bytes_of(packet), [&](const OscMessage&) { ++taken; }))
        << what;
    EXPECT_EQ(taken, 0) << what;
  }
}

TEST(OscParse, RejectsTheWholeOfATruncatedPacket) {
  std::string packet = kHead + sized("/ab\0,sf\0abc\0\0\0\0\1"s);
  EXPECT_TRUE(is_osc(bytes_of(packet)));
  while (packet.size() > kHead.size() + 1) {
    packet.pop_back();
    EXPECT_FALSE(is_osc(bytes_of(packet)));
  }
}

TEST(OscParse, FollowsBundlesOnlySoDeep) {
  std::string packet = "/ab\0,\0\0\0"s;
  for (int depth = 0; depth < kMaxBundleDepth; ++depth) packet = kHead + sized(packet);
  EXPECT_TRUE(is_osc(bytes_of(packet)));
  packet = kHead + sized(packet);
  EXPECT_FALSE(is_osc(bytes_of(packet)));
}

TEST(OscParse, AllocatesNothing) {
  const std::string packet = kHead + sized("/ab\0,sf\0abc\0\0\0\0\1"s);
  int taken = 0;
  const long before = testing::allocations();
  parse_osc(bytes_of(packet), [&taken](const OscMessage&) { ++taken; });
  EXPECT_EQ(testing::allocations() - before, 0);
  EXPECT_EQ(taken, 1);
}

}  // namespace
}  // namespace marey::live
