// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/reopening_device.h"

#include <cerrno>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>

#include "tests/capture/v4l2/fake_kernel.h"

namespace marey::capture {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class Reopening : public testing::Test {
 protected:
  FakeKernel kernel_;
  std::vector<std::string> reported_states_;

  FakeCamera& camera() { return kernel_.cameras[0]; }

  ReopeningDevice open(int frames = 10000) {
    camera().frames = frames_from(0, frames);
    DeviceRequest request;
    request.path = camera().path;
    request.width_px = 640;
    request.height_px = 480;
    auto device = ReopeningDevice::open(
        request,
        [this](const CameraStatus& status) {
          reported_states_.emplace_back(name(status.state));
        },
        {},
        kernel_);
    EXPECT_TRUE(device);
    return *std::move(device);
  }

  /// Returns the frames received within `duration`, in steps of 100 ms.
  int run(ReopeningDevice& device, Timestamp duration) {
    int frames = 0;
    const Timestamp end = kernel_.now() + duration;
    while (kernel_.now() < end) frames += device.next(milliseconds(100)) ? 1 : 0;
    return frames;
  }
};

TEST_F(Reopening, WithoutItsCameraDoesNotBegin) {
  camera().plugged = false;
  DeviceRequest request;
  request.path = camera().path;
  const auto device = ReopeningDevice::open(request, {}, {}, kernel_);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().cause, "the device does not exist");
}

TEST_F(Reopening, ReportsNothingDuringNormalStreaming) {
  ReopeningDevice device = open();
  EXPECT_NEAR(run(device, seconds(3)), 90, 2);
  EXPECT_TRUE(reported_states_.empty());
  EXPECT_EQ(device.status().losses, 0);
}

TEST_F(Reopening, NoticesAnUnplugWithinASecond) {
  for (const bool silently : {false, true}) {
    camera().plugged = true;
    ReopeningDevice device = open();
    run(device, seconds(1));
    camera().leaves_silently = silently;
    camera().plugged = false;
    const Timestamp unplugged = kernel_.now();
    while (device.status().state == CameraState::kStreaming) {
      EXPECT_FALSE(device.next(seconds(10)));
    }
    EXPECT_LE(device.status().since - unplugged, seconds(1));
    EXPECT_EQ(device.status().state, CameraState::kLost);
    ASSERT_TRUE(device.status().trouble);
    EXPECT_NE(device.status().trouble->next.find("same port"), std::string::npos);
    EXPECT_EQ(kernel_.open_files, 0)
        << "an open device file would prevent the reconnection";
  }
}

TEST_F(Reopening, IsBackWithinThreeSecondsUnderWhateverPath) {
  ReopeningDevice device = open();
  run(device, seconds(1));
  camera().plugged = false;
  EXPECT_EQ(run(device, seconds(7)), 0);
  camera().path = "/dev/video5";
  camera().plugged = true;
  kernel_.cameras.emplace_back();
  kernel_.cameras.back().bus = "usb-1.9";
  const Timestamp replugged = kernel_.now();
  while (device.status().state != CameraState::kStreaming) {
    static_cast<void>(device.next(milliseconds(100)));
  }
  EXPECT_LE(kernel_.now() - replugged, seconds(3));
  EXPECT_EQ(device.info().path, "/dev/video5");
  EXPECT_EQ(reported_states_, (std::vector<std::string>{"lost", "streaming"}));
  EXPECT_EQ(device.status().losses, 1);
  EXPECT_EQ(device.status().restarts, 1);
}

TEST_F(Reopening, WaitsForTheSameCameraAtTheSamePort) {
  ReopeningDevice device = open();
  run(device, seconds(1));
  camera().card = "Another Cam";
  camera().plugged = false;
  run(device, seconds(1));
  camera().plugged = true;
  EXPECT_EQ(run(device, seconds(5)), 0);
  EXPECT_EQ(device.status().state, CameraState::kLost);
}

TEST_F(Reopening, TriesAgainWhileTheReturnedCameraRefuses) {
  ReopeningDevice device = open();
  run(device, seconds(1));
  camera().plugged = false;
  run(device, seconds(1));
  camera().plugged = true;
  kernel_.refuse(VIDIOC_STREAMON, EPROTO, 2);
  while (device.status().trouble->cause.find("STREAMON") == std::string::npos) {
    ASSERT_FALSE(device.next(milliseconds(100)));
  }
  EXPECT_GT(run(device, seconds(2)), 10);
  EXPECT_EQ(device.status().losses, 1);
}

TEST_F(Reopening, SurvivesADriverThatFailsForGood) {
  ReopeningDevice device = open();
  run(device, seconds(1));
  kernel_.refuse(VIDIOC_DQBUF, EIO, 1);
  EXPECT_GT(run(device, seconds(3)), 60);
  EXPECT_EQ(reported_states_, (std::vector<std::string>{"lost", "streaming"}));
}

TEST_F(Reopening, DoesNotTryWithoutPauseWhereEveryAttemptFailsSoon) {
  ReopeningDevice device = open();
  kernel_.refuse(VIDIOC_DQBUF, EIO, 1'000'000);
  kernel_.events = POLLERR;
  const int before = kernel_.opened;
  run(device, seconds(10));
  EXPECT_LE(kernel_.opened - before, 3 * 22) << "three files for each attempt";
}

TEST_F(Reopening, ReportsSilenceOnceAndReopensASilentCamera) {
  ReopeningDevice device = open(30);
  run(device, milliseconds(2500));
  EXPECT_EQ(reported_states_, std::vector<std::string>{"silent"});
  EXPECT_EQ(device.status().losses, 0);
  run(device, seconds(5));
  EXPECT_EQ(device.status().restarts, 1);
  EXPECT_EQ(reported_states_, std::vector<std::string>{"silent"})
      << "only once, not after each restart";
  camera().frames = frames_from(0, 100);
  run(device, seconds(1));
  EXPECT_EQ(reported_states_, (std::vector<std::string>{"silent", "streaming"}));
}

TEST_F(Reopening, SumsDroppedAndDamagedFramesButNotOutages) {
  ReopeningDevice device = open(20);
  camera().frames[5].flags = V4L2_BUF_FLAG_ERROR;
  camera().frames.erase(camera().frames.begin() + 10, camera().frames.begin() + 13);
  run(device, seconds(1));
  camera().plugged = false;
  run(device, seconds(1));
  camera().plugged = true;
  camera().frames = frames_from(500, 10);
  run(device, milliseconds(900));
  EXPECT_EQ(device.status().frames, 27);
  EXPECT_EQ(device.status().dropped_frames, 3);
  EXPECT_EQ(device.status().damaged_frames, 1);
}

}  // namespace
}  // namespace marey::capture
