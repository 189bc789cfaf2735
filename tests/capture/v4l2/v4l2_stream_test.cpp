// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/v4l2/v4l2_stream.h"

#include <cerrno>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>

#include "capture/v4l2/v4l2_device.h"
#include "tests/capture/v4l2/fake_kernel.h"

namespace marey::capture {
namespace {

using std::chrono::milliseconds;

class V4l2Frames : public testing::Test {
 protected:
  FakeKernel kernel_;
  FakeCamera& camera_ = kernel_.cameras[0];

  V4l2Device open() {
    DeviceRequest request;
    request.path = camera_.path;
    request.width_px = 640;
    request.height_px = 480;
    auto device = V4l2Device::open(request, kernel_);
    EXPECT_TRUE(device);
    return *std::move(device);
  }

  void use_mjpg() { camera_.formats = {{V4L2_PIX_FMT_MJPEG, {{}}}}; }

  /// Sequence numbers of all frames until none arrives, and the total number of dropped
  /// frames.
  struct Counted {
    std::vector<std::uint32_t> sequences;
    int dropped = 0;
    int damaged = 0;
  };
  Counted count(V4l2Device& device) {
    Counted counted;
    while (true) {
      const auto frame = device.next(milliseconds(200));
      EXPECT_TRUE(frame);
      if (!frame || !*frame) return counted;
      counted.sequences.push_back((*frame)->sequence);
      counted.dropped += (*frame)->dropped_before;
      counted.damaged += (*frame)->damaged ? 1 : 0;
    }
  }
};

TEST(V4l2FramesBetween, CountsSkippedSequenceNumbers) {
  EXPECT_EQ(frames_between(4, 5), 0);
  EXPECT_EQ(frames_between(4, 9), 4);
  EXPECT_EQ(frames_between(0xFFFFFFFFU, 0), 0);
  EXPECT_EQ(frames_between(0xFFFFFFFEU, 2), 3);
  EXPECT_EQ(frames_between(7, 7), 0) << "drivers that do not count";
  EXPECT_EQ(frames_between(900, 0), 0) << "drivers that restarted their count";
}

TEST_F(V4l2Frames, ComeWithTheKernelsStampAndNumber) {
  camera_.frames = frames_from(0, 3);
  V4l2Device device = open();
  const auto first = device.next(milliseconds(100));
  ASSERT_TRUE(first && *first);
  EXPECT_EQ((*first)->time, kernel_.now());
  EXPECT_FALSE((*first)->time_is_arrival);
  EXPECT_EQ((*first)->bytes.size(), 640U * 480U * 2U);
  EXPECT_TRUE(device.settings().monotonic_clock);
  EXPECT_EQ(count(device).sequences, (std::vector<std::uint32_t>{1, 2}));
}

TEST_F(V4l2Frames, ThatAreMissingAreCountedExactlyAcrossTheWrapAround) {
  camera_.frames = frames_from(0xFFFFFFFCU, 12);
  camera_.frames.erase(camera_.frames.begin() + 2, camera_.frames.begin() + 6);
  camera_.frames.erase(camera_.frames.begin() + 5);
  V4l2Device device = open();
  const Counted counted = count(device);
  EXPECT_EQ(counted.sequences.size(), 7U);
  EXPECT_EQ(counted.dropped, 5);
}

TEST_F(V4l2Frames, SkipStaleFramesBeforeTheStartWithoutCountingALoss) {
  use_mjpg();
  camera_.stamp_flags = 0;
  camera_.frames = frames_from(10, 4);
  FakeFrame stale;
  stale.stamp = kernel_.now() - milliseconds(300);
  camera_.frames.push_front(stale);
  V4l2Device device = open();
  const Counted counted = count(device);
  EXPECT_EQ(counted.sequences, (std::vector<std::uint32_t>{10, 11, 12, 13}));
  EXPECT_EQ(counted.dropped, 0);
  EXPECT_FALSE(device.settings().monotonic_clock);
}

TEST_F(V4l2Frames, ThatAreNoJpegAreSkippedAtTheStartAndDamagedLater) {
  use_mjpg();
  camera_.frames = frames_from(0, 5);
  camera_.frames[0].first_bytes[0] = 0;
  camera_.frames[1].bytes_used = 0;
  camera_.frames[3].first_bytes[0] = 0;
  V4l2Device device = open();
  const Counted counted = count(device);
  EXPECT_EQ(counted.sequences, (std::vector<std::uint32_t>{2, 3, 4}));
  EXPECT_EQ(counted.damaged, 1);
  EXPECT_EQ(counted.dropped, 0);
}

TEST_F(V4l2Frames, ThatAreNeverGoodAreNotSkippedForEver) {
  use_mjpg();
  camera_.frames = frames_from(0, 10);
  for (FakeFrame& frame : camera_.frames) frame.first_bytes[0] = 0;
  V4l2Device device = open();
  EXPECT_EQ(count(device).damaged, 6) << "of ten, without the first four";
}

TEST_F(V4l2Frames, WithTheErrorFlagOrTooFewBytesAreDamaged) {
  camera_.frames = frames_from(0, 4);
  camera_.frames[1].flags = V4L2_BUF_FLAG_ERROR;
  camera_.frames[2].bytes_used = 1000;
  V4l2Device device = open();
  const Counted counted = count(device);
  EXPECT_EQ(counted.sequences.size(), 4U);
  EXPECT_EQ(counted.damaged, 2);
}

TEST_F(V4l2Frames, MayBeStampedSlightlyInTheFuture) {
  camera_.frames = frames_from(0, 1);
  const Timestamp stamp = kernel_.now() + milliseconds(61);
  camera_.frames[0].stamp = stamp;
  V4l2Device device = open();
  const auto frame = device.next(milliseconds(100));
  ASSERT_TRUE(frame && *frame);
  EXPECT_EQ((*frame)->time, stamp);
}

TEST_F(V4l2Frames, WithSenselessStampsGetTheTimeOfTheirArrival) {
  for (const Timestamp stamp : {Timestamp{0},
                                Timestamp{std::chrono::hours(480000)},
                                Timestamp{std::chrono::hours(-2)}}) {
    camera_.frames = frames_from(0, 1);
    camera_.frames[0].stamp = stamp;
    V4l2Device device = open();
    const auto frame = device.next(milliseconds(100));
    ASSERT_TRUE(frame && *frame);
    EXPECT_TRUE((*frame)->time_is_arrival);
    EXPECT_EQ((*frame)->time, kernel_.now());
  }
}

TEST_F(V4l2Frames, WithStampsBeyondAnyClockGetTheTimeOfTheirArrival) {
  // The first is near the present after a multiplication modulo 2^64.
  for (const std::int64_t stamp_s : {std::int64_t{18446745073},
                                     std::numeric_limits<std::int64_t>::max(),
                                     std::numeric_limits<std::int64_t>::min()}) {
    camera_.frames = frames_from(0, 1);
    camera_.frames[0].stamp_s = stamp_s;
    V4l2Device device = open();
    const auto frame = device.next(milliseconds(100));
    ASSERT_TRUE(frame && *frame);
    EXPECT_TRUE((*frame)->time_is_arrival) << stamp_s;
    EXPECT_EQ((*frame)->time, kernel_.now());
  }
}

TEST_F(V4l2Frames, AreStampedASecondAheadAtMost) {
  for (const auto& [ahead, sane] :
       {std::pair{milliseconds(900), true}, std::pair{milliseconds(1100), false}}) {
    camera_.frames = frames_from(0, 1);
    camera_.frames[0].wait = milliseconds(0);
    camera_.frames[0].stamp = kernel_.now() + ahead;
    V4l2Device device = open();
    const auto frame = device.next(milliseconds(100));
    ASSERT_TRUE(frame && *frame);
    EXPECT_EQ((*frame)->time_is_arrival, !sane) << ahead.count();
  }
}

TEST_F(V4l2Frames, ThatDoNotComeEndInTheTimeOut) {
  V4l2Device device = open();
  const Timestamp before = kernel_.now();
  const auto frame = device.next(milliseconds(150));
  ASSERT_TRUE(frame);
  EXPECT_FALSE(*frame);
  EXPECT_GE(kernel_.now() - before, milliseconds(150));
  EXPECT_LE(kernel_.now() - before, milliseconds(160));
}

TEST_F(V4l2Frames, SurviveARefusedBuffer) {
  camera_.frames = frames_from(0, 20);
  V4l2Device device = open();
  ASSERT_TRUE(device.next(milliseconds(100)));
  kernel_.refuse(VIDIOC_QBUF, EINVAL, 2);
  const Counted counted = count(device);
  EXPECT_EQ(counted.sequences.size(), 19U);
  EXPECT_EQ(camera_.queued.size(), 4U) << "every buffer is back";
}

TEST_F(V4l2Frames, EndWhenEveryBufferIsRefused) {
  camera_.frames = frames_from(0, 20);
  V4l2Device device = open();
  kernel_.refuse(VIDIOC_QBUF, EINVAL, 10000);
  int frames = 0;
  while (true) {
    const auto frame = device.next(milliseconds(100));
    if (!frame) {
      EXPECT_NE(frame.error().cause.find("QBUF"), std::string::npos);
      break;
    }
    ASSERT_LE(++frames, 4);
  }
}

TEST_F(V4l2Frames, SurviveASignalAndAFalseAlarm) {
  camera_.frames = frames_from(0, 1);
  V4l2Device device = open();
  kernel_.refuse(VIDIOC_DQBUF, EAGAIN, 1);
  kernel_.events = -EINTR;
  EXPECT_FALSE(*device.next(milliseconds(20)));
  kernel_.events = 0;
  EXPECT_EQ(count(device).sequences.size(), 1U);
}

TEST_F(V4l2Frames, EndWithAnErrorWhenTheDriverFails) {
  camera_.frames = frames_from(0, 5);
  V4l2Device device = open();
  kernel_.events = POLLERR;
  kernel_.refuse(VIDIOC_DQBUF, EIO, 1);
  const auto frame = device.next(milliseconds(100));
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().cause, "it stopped streaming: Input/output error");
}

TEST_F(V4l2Frames, EndWhenTheCameraIsUnplugged) {
  for (const bool silently : {false, true}) {
    camera_.plugged = true;
    camera_.leaves_silently = silently;
    V4l2Device device = open();
    camera_.plugged = false;
    const Timestamp before = kernel_.now();
    const auto frame = device.next(milliseconds(500));
    ASSERT_FALSE(frame);
    EXPECT_NE(frame.error().cause.find("unplugged"), std::string::npos);
    EXPECT_LE(kernel_.now() - before, milliseconds(510));
  }
}

TEST_F(V4l2Frames, LeaveNothingBehind) {
  camera_.frames = frames_from(0, 5);
  {
    V4l2Device device = open();
    V4l2Device moved = std::move(device);
    EXPECT_EQ(count(moved).sequences.size(), 5U);
    EXPECT_EQ(camera_.maps, 4);
    EXPECT_TRUE(camera_.streaming);
  }
  EXPECT_EQ(camera_.maps, 0);
  EXPECT_FALSE(camera_.streaming);
  EXPECT_EQ(kernel_.open_files, 0);
}

}  // namespace
}  // namespace marey::capture
