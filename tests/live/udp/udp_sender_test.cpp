// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/udp/udp_sender.h"

#include <vector>

#include <gtest/gtest.h>

#include "live/udp/udp_listener.h"

namespace marey::live {
namespace {

using namespace std::chrono_literals;

const std::vector<std::uint8_t> kPacket{1, 2, 3, 4};

UdpAddress here(int port) {
  return {"127.0.0.1", port};
}

TEST(UdpAddress, IsReadWithAndWithoutAPort) {
  EXPECT_EQ(text_of(*parse_udp_address("studio:39539", 1)), "studio:39539");
  EXPECT_EQ(text_of(*parse_udp_address("10.0.0.7", 39539)), "10.0.0.7:39539");
  EXPECT_EQ(text_of(*parse_udp_address("[::1]:9000", 1)), "[::1]:9000");
  EXPECT_EQ(text_of(*parse_udp_address("::1", 9000)), "[::1]:9000");
}

TEST(UdpAddress, IsDeclinedWhenItIsUnclear) {
  for (const char* text : {"",
                           ":39539",
                           "a:",
                           "a:0",
                           "a:65536",
                           "a:12x",
                           "a:-1",
                           "[::1",
                           "[::1]9000",
                           "[]:1",
                           "a: 1"}) {
    const auto address = parse_udp_address(text, 1);
    ASSERT_FALSE(address) << text;
    EXPECT_EQ(address.error().code, Errc::kBadInput);
  }
}

// "localhost" is ::1, too, where b is not.
TEST(UdpSender, ReachesEveryTarget) {
  auto a = *UdpListener::open(here(0));
  auto b = *UdpListener::open(here(0));
  const std::vector<UdpAddress> targets{here(a.port()), {"localhost", b.port()}};
  auto sender = *UdpSender::open(targets);
  sender.send(kPacket);
  for (UdpListener* listener : {&a, &b}) {
    listener->wait(1000ms);
    const auto packet = listener->receive();
    ASSERT_TRUE(packet);
    EXPECT_EQ(std::vector<std::uint8_t>(packet->begin(), packet->end()), kPacket);
    EXPECT_FALSE(listener->receive());
  }
  EXPECT_EQ(sender.counts()[0].sent, 1);
  EXPECT_EQ(sender.counts()[0].failed + sender.counts()[0].refused, 0);
}

TEST(UdpSender, KeepsSendingWhenATargetClosesAndReopens) {
  auto other = *UdpListener::open(here(0));
  int port = 0;
  {
    const auto gone = *UdpListener::open(here(0));
    port = gone.port();
  }
  const std::vector<UdpAddress> targets{here(port), here(other.port())};
  auto sender = *UdpSender::open(targets);
  for (int i = 0; i < 5; ++i) sender.send(kPacket);
  // The kernel reports a refusal with a later packet: the last refusal is not counted
  // yet.
  EXPECT_GE(sender.counts()[0].refused, 1);
  EXPECT_EQ(sender.counts()[1].sent, 5);
  EXPECT_EQ(sender.counts()[1].failed + sender.counts()[1].refused, 0);

  auto back = *UdpListener::open(here(port));
  sender.send(kPacket);
  back.wait(1000ms);
  EXPECT_TRUE(back.receive());
}

TEST(UdpSender, CountsOversizedPacketsAndContinues) {
  auto listener = *UdpListener::open(here(0));
  const std::vector<UdpAddress> targets{here(listener.port())};
  auto sender = *UdpSender::open(targets);
  sender.send(std::vector<std::uint8_t>(70000));
  sender.send(kPacket);
  EXPECT_EQ(sender.counts()[0].failed, 1);
  EXPECT_EQ(sender.counts()[0].sent, 1);
}

TEST(UdpSender, NeverWaitsForAReceiverThatDoesNotRead) {
  auto listener = *UdpListener::open(here(0));
  const std::vector<UdpAddress> targets{here(listener.port())};
  auto sender = *UdpSender::open(targets);
  const std::vector<std::uint8_t> large(60000);
  for (int i = 0; i < 200; ++i) sender.send(large);
  const UdpCounts& counts = sender.counts()[0];
  EXPECT_EQ(counts.sent + counts.failed, 200);
}

TEST(UdpSender, ReportsAnUnknownHost) {
  // RFC 6761 reserves the domain "invalid": no host has such a name.
  const std::vector<UdpAddress> targets{{"nobody.invalid", 39539}};
  const auto sender = UdpSender::open(targets);
  ASSERT_FALSE(sender);
  EXPECT_NE(sender.error().message().find("nobody.invalid:39539"), std::string::npos);
  EXPECT_FALSE(sender.error().next.empty());
  // Without a network, the resolver cannot decide: the error is one of the device.
  EXPECT_TRUE(sender.error().code == Errc::kBadInput ||
              sender.error().code == Errc::kDevice);
}

TEST(UdpListener, ReportsAPortInUse) {
  const auto first = *UdpListener::open(here(0));
  const auto second = UdpListener::open(here(first.port()));
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::kDevice);
  EXPECT_NE(second.error().message().find(std::to_string(first.port())),
            std::string::npos);
  EXPECT_FALSE(second.error().next.empty());
}

TEST(UdpListener, DeclinesAnAddressOfAnotherMachine) {
  // RFC 5737 reserves this address for documentation: no machine has it.
  const auto listener = UdpListener::open({"192.0.2.1", 0});
  ASSERT_FALSE(listener);
  EXPECT_EQ(listener.error().code, Errc::kBadInput);
}

}  // namespace
}  // namespace marey::live
