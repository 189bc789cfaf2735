// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/vmc_receiver.h"

#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "live/vmc/vmc_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace marey::live {
namespace {

using namespace std::chrono_literals;

VmcSender sender_to(const VmcReceiver& receiver) {
  return *VmcSender::open(
      {.targets = {{"127.0.0.1", receiver.port()}}, .listen = std::nullopt});
}

VmcPose body_at_rest() {
  const Skeleton body = make_humanoid(average_proportions(1.7));
  VmcPose sent;
  VmcBody::make(body)->to_vmc(rest_pose(body), sent);
  return sent;
}

TEST(VmcReceiver, ReceivesTheFramesOfASender) {
  auto receiver = *VmcReceiver::open({"127.0.0.1", 0});
  auto sender = sender_to(receiver);
  const VmcPose sent = body_at_rest();
  VmcFrame frame;
  EXPECT_FALSE(receiver.receive(frame));
  for (int i = 0; i < 3; ++i) sender.send(i * 10ms, sent, {.tracking = i != 2});
  receiver.wait(1000ms);
  ASSERT_TRUE(receiver.receive(frame));
  EXPECT_EQ(frame.pose.has, sent.has);
  EXPECT_NEAR(*frame.time_s, 0.02, 1e-6);
  EXPECT_FALSE(frame.status.tracking);
  EXPECT_EQ(receiver.received().packets, 3);
  EXPECT_EQ(receiver.received().frames, 3);
}

TEST(VmcReceiver, CanReturnEveryFrame) {
  auto receiver = *VmcReceiver::open({"127.0.0.1", 0});
  auto sender = sender_to(receiver);
  const VmcPose sent = body_at_rest();
  VmcFrame frame;
  EXPECT_FALSE(receiver.receive_next(frame));
  for (int i = 0; i < 20; ++i) sender.send(i * 10ms, sent);
  for (int i = 1; i < 20; ++i) {  // The first is known to be one with the second.
    receiver.wait(1000ms);
    ASSERT_TRUE(receiver.receive_next(frame)) << i;
    EXPECT_NEAR(*frame.time_s, 0.01 * i, 1e-6);
    EXPECT_EQ(frame.pose.has, sent.has);
  }
  EXPECT_FALSE(receiver.receive_next(frame));
}

TEST(VmcReceiver, CountsAndDropsForeignPackets) {
  auto receiver = *VmcReceiver::open({"127.0.0.1", 0});
  const std::vector<UdpAddress> targets{{"127.0.0.1", receiver.port()}};
  auto stranger = *UdpSender::open(targets);
  stranger.send({});
  stranger.send(std::vector<std::uint8_t>(1000, 0xff));
  stranger.send(std::vector<std::uint8_t>{'/', 'a', 0, 0, ',', 0, 0, 0});
  VmcFrame frame;
  EXPECT_FALSE(receiver.receive(frame));
  EXPECT_EQ(receiver.received().packets, 3);
  EXPECT_EQ(receiver.received().malformed, 2);
  EXPECT_EQ(receiver.received().ignored, 1);
}

TEST(VmcReceiver, ReportsAPortInUse) {
  const auto first = *VmcReceiver::open({"127.0.0.1", 0});
  const auto second = VmcReceiver::open({"127.0.0.1", first.port()});
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::kDevice);
}

}  // namespace
}  // namespace marey::live
