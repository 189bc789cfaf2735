// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_health.h"

#include <chrono>
#include <optional>

#include <gtest/gtest.h>

#include "app/live_outputs.h"

namespace marey::app {
namespace {

using namespace std::chrono_literals;
using live::PageCameraState;

TEST(LiveHealth, TellsOfACameraThatIsLostAndBack) {
  LiveCameraFigures before;
  before.pictures = 10;
  LiveCameraFigures now = before;
  EXPECT_EQ(camera_status(now, nullptr, 3).state, PageCameraState::kStreaming);
  EXPECT_EQ(camera_status(now, &before, 3).state, PageCameraState::kSilent);
  EXPECT_EQ(camera_status(now, &before, 3).tags, 0) << "of a picture that is old";
  now.pictures = 11;
  now.health = {capture::CameraState::kLost, "/dev/video0: it was unplugged"};
  EXPECT_EQ(camera_status(now, &before, 3).state, PageCameraState::kLost);
  EXPECT_EQ(camera_status(now, &before, 3).detail, now.health.trouble);
  now.health = {};
  EXPECT_EQ(camera_status(now, &before, 3).state, PageCameraState::kStreaming);
  EXPECT_EQ(camera_status(now, &before, 3).detail, "");
}

/// Packets of one stream.
class LiveNetwork : public ::testing::Test {
 protected:
  /// One frame sent; what the page would tell of it.
  live::PageOutput send(LiveOutputs& outputs) {
    LiveResult result;
    result.packets = packets_;
    outputs.send(result);
    const OutputCounts now = outputs.counts().front();
    const auto told = output_status(now, before_ ? &*before_ : nullptr);
    before_ = now;
    return told;
  }

  static LiveOutputs open(const live::UdpAddress& address) {
    return *LiveOutputs::open({VmcStream{}}, {{{address}}});
  }

  std::vector<std::vector<std::vector<std::uint8_t>>> packets_{{{1, 2, 3, 4}}};
  std::optional<OutputCounts> before_;
};

TEST_F(LiveNetwork, TellsThatATargetIsGoneAndThatItIsBack) {
  int port = 0;
  {
    const auto gone = *live::UdpListener::open({"127.0.0.1", 0});
    port = gone.port();
  }
  LiveOutputs outputs = open({"127.0.0.1", port});
  (void)send(outputs);
  (void)send(outputs);  // The kernel tells of a refusal with the next packet.
  EXPECT_EQ(send(outputs).detail, "nobody listens there");
  auto back = *live::UdpListener::open({"127.0.0.1", port});
  (void)send(outputs);
  const auto told = send(outputs);
  EXPECT_EQ(told.detail, "");
  EXPECT_GT(told.failed, 0U);
  back.wait(1000ms);
  EXPECT_TRUE(back.receive());
}

// What no route leads to, or no answer comes from, is tried again with each packet.
TEST_F(LiveNetwork, IsNotHeldUpByAHostThatCannotBeReached) {
  // RFC 5737: for documentation, nobody's.
  auto outputs = LiveOutputs::open({VmcStream{}}, {{{{"192.0.2.1", 39539}}}});
  if (!outputs) {
    EXPECT_EQ(outputs.error().code, Errc::kDevice);
    GTEST_SKIP() << "there is no network here that leads there";
  }
  for (int i = 1; i <= 50; ++i) {
    const auto told = send(*outputs);
    EXPECT_EQ(told.sent + told.failed, static_cast<std::uint64_t>(i));
  }
}

}  // namespace
}  // namespace marey::app
