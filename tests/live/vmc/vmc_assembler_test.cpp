// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "live/vmc/vmc_assembler.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/human/average_proportions.h"
#include "live/vmc/osc_writer.h"
#include "live/vmc/vmc_body.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/program/count_allocations.h"

namespace marey::live {
namespace {

using namespace std::chrono_literals;

using Packets = std::vector<std::vector<std::uint8_t>>;

Packets copied(std::span<const std::span<const std::uint8_t>> packets) {
  Packets all;
  for (const auto packet : packets) all.emplace_back(packet.begin(), packet.end());
  return all;
}

/// A performance of `frames` frames, 10 ms apart, each its packets.
struct Performance {
  Skeleton body = make_humanoid(average_proportions(1.7));
  VmcBody vmc = *VmcBody::make(body);
  std::vector<Pose> poses;
  std::vector<VmcPose> sent;
  std::vector<Packets> packets;

  explicit Performance(int frames, std::optional<int> mtu_bytes = std::nullopt) {
    testing::Dice dice(1);
    VmcEncoder encoder = *VmcEncoder::make({.mtu_bytes = mtu_bytes});
    for (int frame = 0; frame < frames; ++frame) {
      poses.push_back(testing::random_pose(body, dice));
      vmc.to_vmc(poses.back(), sent.emplace_back());
      packets.push_back(copied(encoder.encode(frame * 10ms, sent.back())));
    }
  }
};

void take_all(VmcAssembler& assembler, const Packets& packets) {
  for (const auto& packet : packets) assembler.take(packet);
}

void expect_same(const VmcPose& got, const VmcPose& sent) {
  EXPECT_EQ(got.has, sent.has);
  for (std::size_t i = 0; i < kUnityBoneCount; ++i) {
    if (!sent.has[i]) continue;
    // Floats, in metres.
    EXPECT_LT(glm::distance(got.local[i].position, sent.local[i].position), 1e-6);
    EXPECT_NEAR(
        std::abs(glm::dot(got.local[i].rotation, sent.local[i].rotation)), 1.0, 1e-6);
  }
}

TEST(VmcAssembler, GivesEveryFrameAsSoonAsItsBundleIsThere) {
  const Performance performance(20);
  VmcAssembler assembler;
  VmcFrame frame;
  take_all(assembler, performance.packets[0]);
  EXPECT_FALSE(assembler.take_frame(frame));  // More bones might follow.
  for (std::size_t i = 1; i < performance.packets.size(); ++i) {
    take_all(assembler, performance.packets[i]);
    ASSERT_TRUE(assembler.take_frame(frame));
    EXPECT_NEAR(*frame.time_s, 0.01 * static_cast<double>(i), 1e-6);
    EXPECT_TRUE(frame.status.tracking);
    expect_same(frame.pose, performance.sent[i]);
    EXPECT_FALSE(assembler.take_frame(frame));
  }
  EXPECT_EQ(assembler.received().frames, 20);
  EXPECT_EQ(assembler.received().incomplete, 0);
  EXPECT_EQ(assembler.received().bones, 20 * 22);
}

TEST(VmcAssembler, GivesThePoseOfTheAvatarToAMicrometre) {
  const Performance performance(5);
  VmcAssembler assembler;
  VmcFrame frame;
  Pose shown;
  for (std::size_t i = 0; i < 5; ++i) {
    take_all(assembler, performance.packets[i]);
    if (!assembler.take_frame(frame)) continue;
    performance.vmc.from_vmc(frame.pose, shown);
    const auto expected = world_from_joints(performance.body, performance.poses[i]);
    const auto got = world_from_joints(performance.body, shown);
    for (std::size_t k = 0; k < got.size(); ++k) {
      EXPECT_LT(glm::distance(got[k].translation, expected[k].translation), 2e-6);
    }
  }
}

TEST(VmcAssembler, PutsFramesOfSeveralPacketsTogether) {
  const Performance performance(6, 600);
  ASSERT_GE(performance.packets[0].size(), 4U);
  VmcAssembler assembler;
  VmcFrame frame;
  for (std::size_t i = 0; i < 6; ++i) {
    take_all(assembler, performance.packets[i]);
    EXPECT_EQ(assembler.take_frame(frame), i > 0);
    if (i == 0) continue;
    expect_same(frame.pose, performance.sent[i]);
    EXPECT_NEAR(*frame.time_s, 0.01 * static_cast<double>(i), 1e-6);
  }
}

TEST(VmcAssembler, DropsAFrameOfWhichAPacketWasLost) {
  const Performance performance(6, 1000);
  VmcAssembler assembler;
  VmcFrame frame;
  for (std::size_t i = 0; i < 6; ++i) {
    Packets packets = performance.packets[i];
    if (i == 3) packets.pop_back();
    take_all(assembler, packets);
    ASSERT_EQ(assembler.take_frame(frame), i != 0 && i != 3);
    if (i == 0 || i == 3) continue;
    expect_same(frame.pose, performance.sent[i]);
  }
  EXPECT_EQ(assembler.received().incomplete, 1);
}

/// A sender that composes packets of its own layout; each send() passes one packet.
struct OtherSender {
  OscWriter writer;
  VmcAssembler assembler;

  OtherSender& time(float seconds) {
    writer.begin("/VMC/Ext/T", "f").add(seconds);
    return *this;
  }
  OtherSender& bone(std::string_view name, float x = 0.0F) {
    writer.begin("/VMC/Ext/Bone/Pos", "sfffffff").add(name).add(x);
    for (int i = 0; i < 5; ++i) writer.add(0.0F);
    writer.add(1.0F);
    return *this;
  }
  OtherSender& numbers(const std::vector<float>& seven) {
    writer.begin("/VMC/Ext/Bone/Pos", "sfffffff").add("Hips");
    for (const float number : seven) writer.add(number);
    return *this;
  }
  void send() {
    take_all(assembler, copied(writer.packets()));
    writer.clear();
  }
  [[nodiscard]] std::optional<VmcFrame> frame() {
    VmcFrame taken;
    return assembler.take_frame(taken) ? std::optional(taken) : std::nullopt;
  }
};

double x_of(const VmcFrame& frame, UnityBone bone) {
  return frame.pose.local[index(bone)].position.x;
}

TEST(VmcAssembler, UnderstandsTAtTheEndOfABundle) {
  OtherSender other;
  for (int i = 0; i < 4; ++i) {
    other.bone("Hips").bone("Spine").time(static_cast<float>(i)).send();
    const auto frame = other.frame();
    ASSERT_EQ(frame.has_value(), i > 0);
    EXPECT_TRUE(!frame || frame->time_s == i);
  }
}

TEST(VmcAssembler, UnderstandsSendersWithoutBundlesAndWithoutT) {
  OtherSender other;
  for (int i = 0; i < 4; ++i) {
    other.bone("Hips", static_cast<float>(i)).send();
    other.bone("Spine").send();
    const auto frame = other.frame();
    ASSERT_EQ(frame.has_value(), i > 0);
    if (!frame) continue;
    EXPECT_FALSE(frame->time_s);
    EXPECT_EQ(x_of(*frame, UnityBone::kHips), i);
  }
}

TEST(VmcAssembler, GetsUsedToMoreBones) {
  OtherSender other;
  for (int i = 0; i < 3; ++i) other.time(static_cast<float>(i)).bone("Hips").send();
  (void)other.frame();
  for (int i = 3; i < 6; ++i) {
    other.time(static_cast<float>(i)).bone("Hips").send();
    other.bone("Spine", static_cast<float>(i)).send();
  }
  const auto frame = other.frame();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->time_s, 5.0);
  EXPECT_EQ(x_of(*frame, UnityBone::kSpine), 5.0);
}

TEST(VmcAssembler, GetsUsedToFewerBones) {
  OtherSender other;
  other.time(0.0F).bone("Hips").bone("Spine").send();
  other.time(1.0F).bone("Hips").bone("Spine").send();
  ASSERT_TRUE(other.frame());
  int frames = 0;
  for (int i = 2; i < 12; ++i) {
    other.time(static_cast<float>(i)).bone("Hips").send();
    frames += other.frame().has_value();
  }
  EXPECT_GE(frames, 5);
  EXPECT_LE(other.assembler.received().incomplete, 4);
}

TEST(VmcAssembler, FollowsASenderThatRestarts) {
  OtherSender other;
  for (const float time : {100.0F, 100.1F, 0.0F, 0.1F}) {
    other.time(time).bone("Hips").send();
  }
  const auto frame = other.frame();
  ASSERT_TRUE(frame);
  EXPECT_NEAR(*frame->time_s, 0.1, 1e-6);
}

TEST(VmcAssembler, KeepsFingersEyesAndJawAndCountsThem) {
  OtherSender other;
  for (int i = 0; i < 2; ++i) {
    other.time(static_cast<float>(i)).bone("Hips").bone("jaw").bone("LeftEye");
    other.bone("rightthumbproximal").bone("LeftLittleDistal").send();
  }
  const auto frame = other.frame();
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->pose.contains(UnityBone::kRightThumbProximal));
  EXPECT_EQ(frame->pose.has.count(), 5U);
  EXPECT_EQ(other.assembler.received().bones, 10);
  EXPECT_EQ(other.assembler.received().not_of_ours, 8);
}

TEST(VmcAssembler, DeclinesNumbersThatCannotBe) {
  const float inf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  OtherSender other;
  const std::vector<std::vector<float>> broken{{nan, 0, 0, 0, 0, 0, 1},
                                               {0, inf, 0, 0, 0, 0, 1},
                                               {0, 0, 2e4F, 0, 0, 0, 1},
                                               {0, 0, 0, 0, 0, 0, 0},
                                               {0, 0, 0, 1e-30F, 0, 0, 0},
                                               {0, 0, 0, 0, nan, 0, 1},
                                               {0, 0, 0, 0, 0, -inf, 1},
                                               {3e38F, 3e38F, 3e38F, 0, 0, 0, 1}};
  for (const auto& numbers : broken) other.numbers(numbers).send();
  EXPECT_EQ(other.assembler.received().declined,
            static_cast<std::int64_t>(broken.size()));
  EXPECT_EQ(other.assembler.received().bones, 0);
  // The largest float is a direction like any other.
  for (int i = 0; i < 2; ++i) other.numbers({0, 0, 0, 3e38F, 0, 0, 3e38F}).send();
  const auto frame = other.frame();
  ASSERT_TRUE(frame);
  EXPECT_NEAR(glm::length(frame->pose.local[0].rotation), 1.0, 1e-12);
}

TEST(VmcAssembler, DropsWrongArgumentsAndIgnoresSurplusOnes) {
  OtherSender other;
  other.writer.begin("/VMC/Ext/Bone/Pos", "sfff").add("Hips").add(0.F).add(0.F).add(0.F);
  other.writer.begin("/VMC/Ext/Bone/Pos", "f").add(1.0F);
  other.writer.begin("/VMC/Ext/Bone/Pos", "");
  other.writer.begin("/VMC/Ext/T", "s").add("noon");
  other.writer.begin("/VMC/Ext/OK", "f").add(1.0F);
  other.bone("Tail");
  other.send();
  EXPECT_EQ(other.assembler.received().declined, 6);
  other.writer.begin("/VMC/Ext/Blend/Apply", "");
  other.writer.begin("/tracking/trackers/1/position", "f").add(1.0F);
  other.writer.begin("/VMC/Ext/OK", "iiiis").add(1).add(2).add(1).add(0).add("more");
  other.send();
  EXPECT_EQ(other.assembler.received().declined, 6);
  EXPECT_EQ(other.assembler.received().ignored, 2);
  other.bone("Hips").send();
  other.bone("Hips").send();
  const auto frame = other.frame();
  ASSERT_TRUE(frame);
  EXPECT_FALSE(frame->status.tracking);
  EXPECT_EQ(frame->status.calibration, 2);
}

// Flips bytes of sound packets: what arrives is sound or dropped, and nothing breaks.
TEST(VmcAssembler, GivesSoundFramesWhateverComes) {
  const Performance performance(4);
  testing::Dice dice(2);
  VmcAssembler assembler;
  VmcFrame frame;
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::uint8_t> packet =
        performance.packets[static_cast<std::size_t>(i % 4)][0];
    for (int k = 0; k < 3; ++k) {
      const double at = dice.between(0.0, static_cast<double>(packet.size()) - 1.0);
      packet[static_cast<std::size_t>(at)] =
          static_cast<std::uint8_t>(dice.between(0.0, 255.0));
    }
    if (i % 7 == 0) packet.resize(packet.size() / 2);
    assembler.take(packet);
    if (!assembler.take_frame(frame)) continue;
    for (std::size_t k = 0; k < kUnityBoneCount; ++k) {
      if (!frame.pose.has[k]) continue;
      EXPECT_NEAR(glm::length(frame.pose.local[k].rotation), 1.0, 1e-12);
      EXPECT_LE(glm::length(frame.pose.local[k].position), 10e3);
    }
  }
  EXPECT_GT(assembler.received().malformed, 100);
  EXPECT_GT(assembler.received().frames, 100);
}

TEST(VmcAssembler, AllocatesNothing) {
  const Performance performance(4, 1472);
  VmcAssembler assembler;
  VmcFrame frame;
  const long before = testing::allocations();
  for (const Packets& packets : performance.packets) {
    take_all(assembler, packets);
    (void)assembler.take_frame(frame);
  }
  EXPECT_EQ(testing::allocations() - before, 0);
}

}  // namespace
}  // namespace marey::live
