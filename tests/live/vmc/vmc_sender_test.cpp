// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/vmc_sender.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tests/live/vmc/read_vmc.h"
#include "tests/support/program/count_allocations.h"

namespace marey::live {
namespace {

using namespace std::chrono_literals;

/// A sender on free ports, a receiver of its packets, and a source of commands for it.
struct Stage {
  UdpListener marionette = *UdpListener::open({"127.0.0.1", 0});
  VmcSender sender = *VmcSender::open({.targets = {{"127.0.0.1", marionette.port()}},
                                       .listen = UdpAddress{"127.0.0.1", 0}});
  UdpSender assistant = *UdpSender::open(
      std::vector<UdpAddress>{{"127.0.0.1", sender.listen_port().value_or(0)}});
  int frame = 0;
  VmcPose pose;

  Stage() { pose.set(UnityBone::kHips, {}); }

  void command(OscWriter& command) {
    for (const auto packet : command.packets()) assistant.send(packet);
  }
  std::vector<ReadMessage> next_frame() {
    sender.send(frame++ * 10ms, pose);
    const auto packet = marionette.receive();
    return packet ? read_by_liblo(*packet) : std::vector<ReadMessage>{};
  }
};

int count_messages(const std::vector<ReadMessage>& messages, const std::string& address) {
  return static_cast<int>(std::ranges::count(messages, address, &ReadMessage::address));
}

TEST(VmcSender, SendsOneBundlePerFrameAndItsListenPort) {
  Stage stage;
  const auto first = stage.next_frame();
  EXPECT_EQ(count_messages(first, "/VMC/Ext/Bone/Pos"), 1);
  ASSERT_EQ(count_messages(first, "/VMC/Ext/Rcv"), 1);
  EXPECT_EQ(first.back().numbers[1], *stage.sender.listen_port());
  EXPECT_EQ(count_messages(stage.next_frame(), "/VMC/Ext/Rcv"), 0);
  EXPECT_EQ(stage.sender.counts()[0].sent, 2);
}

TEST(VmcSender, AppliesRequestedPeriods) {
  Stage stage;
  (void)stage.next_frame();
  OscWriter command;
  command.begin("/VMC/Ext/Set/Period", "iiiiii")
      .add(2)
      .add(2)
      .add(4)
      .add(1)
      .add(1)
      .add(1);
  stage.command(command);
  int bones = 0;
  int roots = 0;
  for (int i = 0; i < 8; ++i) {
    const auto messages = stage.next_frame();
    bones += count_messages(messages, "/VMC/Ext/Bone/Pos");
    roots += count_messages(messages, "/VMC/Ext/Root/Pos");
  }
  EXPECT_EQ(bones, 2);
  EXPECT_EQ(roots, 4);
}

TEST(VmcSender, SendsItsInfoOnRequest) {
  Stage stage;
  (void)stage.next_frame();
  OscWriter command;
  command.begin("/VMC/Ext/Set/Req", "");
  stage.command(command);
  EXPECT_EQ(count_messages(stage.next_frame(), "/VMC/Ext/Rcv"), 1);
  EXPECT_EQ(count_messages(stage.next_frame(), "/VMC/Ext/Rcv"), 0);
}

TEST(VmcSender, HandsOverCalibrationsOnce) {
  Stage stage;
  OscWriter command;
  command.begin("/VMC/Ext/Set/Calib/Ready", "");
  command.begin("/VMC/Ext/Set/Calib/Exec", "is").add(2).add("surplus");
  stage.command(command);
  (void)stage.next_frame();
  const VmcCommands commands = stage.sender.take_commands();
  EXPECT_TRUE(commands.calibration_ready);
  EXPECT_EQ(commands.calibration, 2);
  EXPECT_EQ(commands.applied, 2);
  const VmcCommands again = stage.sender.take_commands();
  EXPECT_FALSE(again.calibration_ready);
  EXPECT_FALSE(again.calibration);
  EXPECT_EQ(again.applied, 2);
}

TEST(VmcSender, IgnoresAndCountsUnsupportedRequests) {
  Stage stage;
  OscWriter command;
  command.begin("/VMC/Ext/Set/Period", "iif").add(9).add(9).add(9.0F);
  command.begin("/VMC/Ext/Set/Calib/Exec", "");
  command.begin("/VMC/Ext/Set/Eye", "i").add(1);
  stage.command(command);
  stage.assistant.send(std::vector<std::uint8_t>{'h', 'e', 'l', 'l', 'o'});
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(count_messages(stage.next_frame(), "/VMC/Ext/Bone/Pos"), 1);
  }
  const VmcCommands commands = stage.sender.take_commands();
  EXPECT_EQ(commands.applied, 0);
  EXPECT_EQ(commands.ignored, 3);
  EXPECT_EQ(commands.malformed, 1);
}

TEST(VmcSender, AllocatesNothingPerFrame) {
  Stage stage;
  (void)stage.next_frame();
  OscWriter command;
  command.begin("/VMC/Ext/Set/Req", "");
  stage.command(command);
  const long before = testing::allocations();
  for (int i = 0; i < 20; ++i) stage.sender.send(stage.frame++ * 10ms, stage.pose);
  EXPECT_EQ(testing::allocations() - before, 0);
}

TEST(VmcSender, ReportsAPortInUse) {
  const auto taken = *UdpListener::open({"127.0.0.1", 0});
  const auto sender = VmcSender::open({.targets = {{"127.0.0.1", 39539}},
                                       .listen = UdpAddress{"127.0.0.1", taken.port()}});
  ASSERT_FALSE(sender);
  EXPECT_EQ(sender.error().code, Errc::kDevice);
  EXPECT_NE(sender.error().message().find(std::to_string(taken.port())),
            std::string::npos);
}

}  // namespace
}  // namespace marey::live
