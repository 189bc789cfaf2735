// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/vmc_encoder.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "live/vmc/vmc_body.h"
#include "tests/live/vmc/read_vmc.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/count_allocations.h"

namespace marey::live {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;

/// A frame's packets, copied.
std::vector<std::vector<std::uint8_t>> frame_of(VmcEncoder& encoder,
                                                Timestamp time,
                                                const VmcPose& pose,
                                                const VmcStatus& status = {}) {
  std::vector<std::vector<std::uint8_t>> packets;
  for (const auto packet : encoder.encode(time, pose, status)) {
    packets.emplace_back(packet.begin(), packet.end());
  }
  return packets;
}

std::vector<ReadMessage> messages_of(
    const std::vector<std::vector<std::uint8_t>>& packets) {
  std::vector<ReadMessage> all;
  for (const auto& packet : packets) {
    for (ReadMessage& message : read_by_liblo(packet)) all.push_back(std::move(message));
  }
  return all;
}

int count(const std::vector<ReadMessage>& messages, const std::string& address) {
  return static_cast<int>(std::ranges::count(messages, address, &ReadMessage::address));
}

/// Returns all 22 bones of a random person in a random posture.
VmcPose some_pose(std::uint64_t seed) {
  testing::Dice dice(seed);
  const Skeleton body = testing::random_humanoid(dice);
  VmcPose pose;
  VmcBody::make(body)->to_vmc(testing::random_pose(body, dice), pose);
  return pose;
}

// The bytes of a frame, put together by hand.
TEST(VmcEncoder, WritesTheBytesOfAHandMadeFrame) {
  VmcEncoder encoder = *VmcEncoder::make();
  VmcPose pose;
  pose.set(UnityBone::kHips, {{0.5, 1.0, -0.25}, {0.0, 0.0, 1.0, 0.0}});
  const auto packets = frame_of(encoder, 5s, pose, {.tracking = false});
  ASSERT_EQ(packets.size(), 1U);
  const std::string number0(4, '\0');
  const std::string number1 = "\x3f\x80\0\0"s;
  EXPECT_EQ(std::string(packets[0].begin(), packets[0].end()),
            "#bundle\0\0\0\0\0\0\0\0\1"s + "\0\0\0\x24/VMC/Ext/OK\0,iiii\0\0\0"s +
                "\0\0\0\1\0\0\0\3\0\0\0\0\0\0\0\0"s + "\0\0\0\x14/VMC/Ext/T\0\0,f\0\0"s +
                number0 +
                "\0\0\0\x44/VMC/Ext/Root/Pos\0\0\0,sfffffff\0\0\0root\0\0\0\0"s +
                number0 + number0 + number0 + number0 + number0 + number0 + number1 +
                "\0\0\0\x44/VMC/Ext/Bone/Pos\0\0\0,sfffffff\0\0\0Hips\0\0\0\0"s +
                "\x3f\0\0\0"s + number1 + "\xbe\x80\0\0"s + number0 + number1 + number0 +
                number0);
}

TEST(VmcEncoder, SendsEveryBoneOfAPoseInOneBundle) {
  VmcEncoder encoder = *VmcEncoder::make();
  const auto packets = frame_of(encoder, 0s, some_pose(1));
  ASSERT_EQ(packets.size(), 1U);
  const auto messages = messages_of(packets);
  ASSERT_EQ(messages.size(), 25U);
  EXPECT_EQ(messages[0].address, "/VMC/Ext/OK");
  EXPECT_EQ(messages[1].address, "/VMC/Ext/T");
  EXPECT_EQ(messages[2].address, "/VMC/Ext/Root/Pos");
  std::set<std::string> names;
  for (const ReadMessage& message : messages) {
    if (message.address == "/VMC/Ext/Bone/Pos") names.insert(message.texts[0]);
  }
  for (const HumanBone bone : human_bones()) {
    EXPECT_EQ(names.count(std::string(name(unity_bone(bone)))), 1U);
  }
}

TEST(VmcEncoder, KeepsQuaternionsUnitAndPositionsToTheFloat) {
  VmcEncoder encoder = *VmcEncoder::make();
  const VmcPose pose = some_pose(2);
  for (const ReadMessage& message : messages_of(frame_of(encoder, 0s, pose))) {
    if (message.address != "/VMC/Ext/Bone/Pos") continue;
    const auto& n = message.numbers;
    EXPECT_NEAR(
        std::sqrt(n[3] * n[3] + n[4] * n[4] + n[5] * n[5] + n[6] * n[6]), 1.0, 1e-6);
    EXPECT_GE(n[6], 0.0);
    const UnityTransform& expected = pose.local[index(*unity_bone(message.texts[0]))];
    const double same = n[3] * expected.rotation.x + n[4] * expected.rotation.y +
                        n[5] * expected.rotation.z + n[6] * expected.rotation.w;
    EXPECT_NEAR(std::abs(same), 1.0, 1e-6);
    // A float has 24 bits: below 2 m, 0.1 um.
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(n[static_cast<std::size_t>(i)], expected.position[i], 1.2e-7);
    }
  }
}

TEST(VmcEncoder, GoesOnWithTheTimeOfAnother) {
  VmcEncoder encoder = *VmcEncoder::make({.begin = Timestamp(2s)});
  const auto messages = messages_of(frame_of(encoder, 5s, some_pose(1)));
  EXPECT_EQ(messages[1].address, "/VMC/Ext/T");
  EXPECT_EQ(messages[1].numbers[0], 3.0);
}

TEST(VmcEncoder, SplitsAFrameAtTheLimitWithTInTheFirst) {
  VmcEncoder whole = *VmcEncoder::make();
  VmcEncoder split = *VmcEncoder::make({.mtu_bytes = 1472});
  const VmcPose pose = some_pose(3);
  const auto one = frame_of(whole, 0s, pose);
  const auto several = frame_of(split, 0s, pose);
  ASSERT_EQ(several.size(), 2U);
  for (const auto& packet : several) EXPECT_LE(packet.size(), 1472U);
  const auto first = read_by_liblo(several[0]);
  EXPECT_EQ(first[0].address, "/VMC/Ext/OK");
  EXPECT_EQ(first[1].address, "/VMC/Ext/T");
  const auto all = messages_of(one);
  const auto parts = messages_of(several);
  ASSERT_EQ(all.size(), parts.size());
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i].texts, parts[i].texts);
}

TEST(VmcEncoder, SendsIncreasingTimesSinceTheFirstFrame) {
  VmcEncoder encoder = *VmcEncoder::make();
  const VmcPose nobody;
  double last = -1.0;
  // 60 Hz around a whole day of work, on the clock of a machine that runs for a year.
  const Timestamp start = 24h * 365;
  (void)frame_of(encoder, start, nobody);
  for (int frame = 60 * 86400 - 200; frame < 60 * 86400; ++frame) {
    const auto messages =
        messages_of(frame_of(encoder, start + frame_time(frame, {60.0}), nobody));
    const double now_s = messages[1].numbers[0];
    EXPECT_GT(now_s, last);
    EXPECT_NEAR(now_s, frame / 60.0, 0.004);  // Half a float's step at 2^16.
    last = now_s;
  }
}

TEST(VmcEncoder, SendsStatusRootAndBonesAtTheirPeriods) {
  VmcEncoder encoder = *VmcEncoder::make();
  const VmcPose pose = some_pose(4);
  encoder.set_periods({.status = 2, .root = 3, .bone = 4});
  int packets = 0;
  int ok = 0;
  int root = 0;
  int bones = 0;
  for (int frame = 0; frame < 12; ++frame) {
    const auto sent = frame_of(encoder, frame * 10ms, pose);
    packets += static_cast<int>(sent.size());
    const auto messages = messages_of(sent);
    EXPECT_EQ(count(messages, "/VMC/Ext/T"), static_cast<int>(sent.size()));
    ok += count(messages, "/VMC/Ext/OK");
    root += count(messages, "/VMC/Ext/Root/Pos");
    bones += count(messages, "/VMC/Ext/Bone/Pos");
  }
  EXPECT_EQ(ok, 6);
  EXPECT_EQ(root, 4);
  EXPECT_EQ(bones, 3 * 22);
  EXPECT_EQ(packets, 8);  // 1, 5, 7 and 11 are no multiples of 2 or 3.
}

TEST(VmcEncoder, TakesPeriodsThatCannotBeForTheNearestThatCan) {
  VmcEncoder encoder = *VmcEncoder::make();
  encoder.set_periods({.status = 0, .root = -5, .bone = 2147483647});
  const VmcPose pose = some_pose(5);
  for (int frame = 0; frame < 3; ++frame) {
    const auto messages = messages_of(frame_of(encoder, frame * 10ms, pose));
    EXPECT_EQ(count(messages, "/VMC/Ext/OK"), 1);
    EXPECT_EQ(count(messages, "/VMC/Ext/Root/Pos"), 1);
    EXPECT_EQ(count(messages, "/VMC/Ext/Bone/Pos"), frame == 0 ? 22 : 0);
  }
}

TEST(VmcEncoder, SendsItsInfoAtFirstEverySecondAndOnRequest) {
  VmcEncoderOptions options;
  options.info = {
      .listen_port = 39540, .options = "marey", .vrm_path = "me.vrm", .vrm_title = "Me"};
  VmcEncoder encoder = *VmcEncoder::make(options);
  const VmcPose nobody;
  const auto is_info_sent = [&](Timestamp time) {
    const auto messages = messages_of(frame_of(encoder, time, nobody));
    EXPECT_EQ(count(messages, "/VMC/Ext/Rcv"), count(messages, "/VMC/Ext/VRM"));
    EXPECT_EQ(count(messages, "/VMC/Ext/Opt"), count(messages, "/VMC/Ext/VRM"));
    return count(messages, "/VMC/Ext/VRM") == 1;
  };
  EXPECT_TRUE(is_info_sent(0s));
  EXPECT_FALSE(is_info_sent(500ms));
  encoder.request_info();
  EXPECT_TRUE(is_info_sent(600ms));
  EXPECT_FALSE(is_info_sent(1500ms));
  EXPECT_TRUE(is_info_sent(1600ms));
  const auto messages = messages_of(frame_of(encoder, 3s, nobody));
  EXPECT_EQ(messages.back().texts, (std::vector<std::string>{"me.vrm", "Me"}));
}

TEST(VmcEncoder, GivesTheSameBytesForTheSameFrames) {
  VmcEncoder a = *VmcEncoder::make({.mtu_bytes = 1472});
  VmcEncoder b = *VmcEncoder::make({.mtu_bytes = 1472});
  for (int frame = 0; frame < 5; ++frame) {
    const VmcPose pose = some_pose(static_cast<std::uint64_t>(10 + frame));
    EXPECT_EQ(frame_of(a, frame * 16ms, pose), frame_of(b, frame * 16ms, pose));
  }
}

TEST(VmcEncoder, AllocatesNothingAfterTheFirstFrame) {
  VmcEncoder encoder = *VmcEncoder::make({.mtu_bytes = 1472});
  const VmcPose pose = some_pose(6);
  (void)encoder.encode(0s, pose);
  const long before = testing::allocations();
  for (int frame = 1; frame < 100; ++frame) (void)encoder.encode(frame * 16ms, pose);
  EXPECT_EQ(testing::allocations() - before, 0);
}

TEST(VmcEncoder, DeclinesLimitsThatNothingFitsInto) {
  for (const int bytes : {-1, 0, 103, 65508}) {
    const auto made = VmcEncoder::make({.mtu_bytes = bytes});
    ASSERT_FALSE(made) << bytes;
    EXPECT_EQ(made.error().code, Errc::kBadInput);
  }
  VmcEncoderOptions wordy{.mtu_bytes = 200};
  wordy.info.vrm_title = std::string(200, 'x');
  EXPECT_FALSE(VmcEncoder::make(wordy));
  VmcEncoder tight = *VmcEncoder::make({.mtu_bytes = 104});
  VmcPose pose;
  pose.set(UnityBone::kRightMiddleIntermediate, {});
  for (const auto& packet : frame_of(tight, 0s, pose)) EXPECT_LE(packet.size(), 104U);
}

}  // namespace
}  // namespace marey::live
