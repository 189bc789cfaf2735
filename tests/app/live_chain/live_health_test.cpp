// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_health.h"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/live_chain/live_outputs.h"

namespace marey::app {
namespace {

using namespace std::chrono_literals;
using live::PageCameraState;
using live::PageSubject;
using reconstruct::TrackState;

TEST(LiveHealth, ReportsALostCameraAndItsReturn) {
  LiveCameraFigures before;
  before.pictures = 10;
  LiveCameraFigures now = before;
  EXPECT_EQ(camera_status(now, nullptr, 3).state, PageCameraState::kStreaming);
  EXPECT_EQ(camera_status(now, &before, 3).state, PageCameraState::kSilent);
  EXPECT_EQ(camera_status(now, &before, 3).tags, 0) << "the picture is old";
  now.pictures = 11;
  now.health = {capture::CameraState::kLost, "/dev/video0: it was unplugged"};
  EXPECT_EQ(camera_status(now, &before, 3).state, PageCameraState::kLost);
  EXPECT_EQ(camera_status(now, &before, 3).detail, now.health.trouble);
  now.health = {};
  EXPECT_EQ(camera_status(now, &before, 3).state, PageCameraState::kStreaming);
  EXPECT_EQ(camera_status(now, &before, 3).detail, "");
}

class LiveSubject : public ::testing::Test {
 protected:
  LiveSubject() : figures_(2) {
    status_.cameras = {{"left", PageCameraState::kStreaming, 9, 0, 3, ""},
                       {"right", PageCameraState::kStreaming, 9, 0, 3, ""}};
  }
  [[nodiscard]] live::PageStatus status_of(TrackState state,
                                           const std::vector<std::string>& unseen = {}) {
    live::PageStatus status = status_;
    add_subject_status(state, figures_, unseen, status);
    return status;
  }
  LiveStatistics figures_;
  live::PageStatus status_;
};

TEST_F(LiveSubject, IsWellOnlyWhereTheWorstCameraAndSegmentAre) {
  EXPECT_EQ(status_of(TrackState::kTracked).subject, PageSubject::kTracked);
  EXPECT_TRUE(status_of(TrackState::kTracked).warnings.empty());
  const auto unseen = status_of(TrackState::kTracked, {"leftFoot"});
  EXPECT_EQ(unseen.subject, PageSubject::kPartly);
  ASSERT_EQ(unseen.warnings.size(), 1U);
  EXPECT_EQ(unseen.warnings[0], "leftFoot has not been seen for more than a second");
  for (const auto state : {PageCameraState::kSilent, PageCameraState::kLost}) {
    status_.cameras[1].state = state;
    EXPECT_EQ(status_of(TrackState::kTracked).subject, PageSubject::kPartly);
    EXPECT_NE(status_of(TrackState::kTracked).warnings.at(0).find("right"),
              std::string::npos);
  }
}

TEST_F(LiveSubject, IsNotTrackedWherePosesDoNotKeepUp) {
  figures_.flow_text = "poses fall behind";
  for (const auto state :
       {TrackState::kWaiting, TrackState::kTracked, TrackState::kLost}) {
    figures_.flow = Flow::kBehind;
    EXPECT_EQ(status_of(state).subject, PageSubject::kBehind);
    EXPECT_EQ(status_of(state).warnings.back(), "poses fall behind");
    figures_.flow = Flow::kStopped;
    EXPECT_EQ(status_of(state).subject, PageSubject::kStopped);
  }
  figures_.flow = Flow::kSteady;
  EXPECT_EQ(status_of(TrackState::kLost).subject, PageSubject::kLost);
  EXPECT_EQ(status_of(TrackState::kWaiting).subject, PageSubject::kWaiting);
}

TEST(WornSegments, AreUnseenWhereTheirPlaceIsAGuess) {
  Body body;
  for (const HumanBone bone :
       {HumanBone::kHips, HumanBone::kLeftToes, HumanBone::kHead}) {
    PlacedTag tag;
    tag.tag.segment = bone;
    body.tags.push_back(tag);
    body.tags.push_back(tag);
  }
  std::vector<JointUncertainty> uncertainty(kHumanBoneCount,
                                            {0.01, Source::kMeasured, Source::kMeasured});
  EXPECT_TRUE(WornSegments(body).unseen(uncertainty).empty());
  uncertainty[index(HumanBone::kLeftFoot)].segment_source = Source::kInferred;
  uncertainty[index(HumanBone::kHead)].segment_source = Source::kRepaired;
  uncertainty[index(HumanBone::kRightHand)].segment_source =
      Source::kInferred;  // No tag.
  // Seen, but its joint is known badly.
  uncertainty[index(HumanBone::kHips)] = {0.03, Source::kInferred, Source::kMeasured};
  EXPECT_EQ(WornSegments(body).unseen(uncertainty), std::vector<std::string>{"leftFoot"});
  EXPECT_TRUE(WornSegments(body).unseen({}).empty());
}

/// Packets of one stream.
class LiveNetwork : public ::testing::Test {
 protected:
  /// Sends one frame. Returns the output's status for the page.
  live::PageOutput send(LiveOutputs& outputs) {
    LiveResult result;
    result.packets = packets_;
    outputs.send(result);
    const OutputCounts now = outputs.counts().front();
    const auto status = output_status(now, before_ ? &*before_ : nullptr);
    before_ = now;
    return status;
  }

  static LiveOutputs open(const live::UdpAddress& address) {
    return *LiveOutputs::open({VmcStream{}}, {{{address}}});
  }

  std::vector<std::vector<std::vector<std::uint8_t>>> packets_{{{1, 2, 3, 4}}};
  std::optional<OutputCounts> before_;
};

TEST_F(LiveNetwork, ReportsALostTargetAndItsReturn) {
  int port = 0;
  {
    const auto gone = *live::UdpListener::open({"127.0.0.1", 0});
    port = gone.port();
  }
  LiveOutputs outputs = open({"127.0.0.1", port});
  (void)send(outputs);
  (void)send(outputs);  // The kernel reports a refusal with the next packet.
  EXPECT_EQ(send(outputs).detail, "no program receives the packets there");
  auto back = *live::UdpListener::open({"127.0.0.1", port});
  (void)send(outputs);
  const auto status = send(outputs);
  EXPECT_EQ(status.detail, "");
  EXPECT_GT(status.failed, 0U);
  back.wait(1000ms);
  EXPECT_TRUE(back.receive());
}

// Each packet is a new attempt to reach a host that has no route or does not answer.
TEST_F(LiveNetwork, IsNotHeldUpByAHostThatCannotBeReached) {
  // RFC 5737 reserves this address for documentation: no host has it.
  auto outputs = LiveOutputs::open({VmcStream{}}, {{{{"192.0.2.1", 39539}}}});
  if (!outputs) {
    EXPECT_EQ(outputs.error().code, Errc::kDevice);
    GTEST_SKIP() << "there is no network here that leads there";
  }
  for (int i = 1; i <= 50; ++i) {
    const auto status = send(*outputs);
    EXPECT_EQ(status.sent + status.failed, static_cast<std::uint64_t>(i));
  }
}

}  // namespace
}  // namespace marey::app
