// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/feeds/video_feed.h"

#include <array>
#include <chrono>
#include <cstddef>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/takes/jpeg_encoder.h"
#include "recordings/takes/mjpg_video.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::app {
namespace {

using std::chrono::milliseconds;

constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// A video whose frame k is grey value 20 k all over.
std::filesystem::path make_video(const testing::ScratchFolder& folder, int frames) {
  const auto path = folder / "steps.mkv";
  recordings::MjpgVideoOptions options;
  options.width_px = kWidth;
  options.height_px = kHeight;
  options.rate = {100.0};
  auto video = recordings::MjpgVideo::create(path, options);
  auto encoder = recordings::JpegEncoder::create(
      recordings::RawLayout::kGrey, kWidth, kHeight, kWidth);
  EXPECT_TRUE(video && encoder);
  for (int k = 0; k < frames; ++k) {
    const std::vector<std::byte> pixels(kWidth * kHeight, static_cast<std::byte>(20 * k));
    EXPECT_TRUE(video->write(encoder->encode(pixels), milliseconds(10 * k)));
  }
  EXPECT_TRUE(video->finish());
  return path;
}

Timestamp now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

std::unique_ptr<capture::VideoFeed> open(const capture::VideoFeedOptions& options) {
  auto feed = capture::VideoFeed::open(options);
  EXPECT_TRUE(feed) << feed.error().message();
  return *std::move(feed);
}

int grey_of(const capture::RawFrame& frame) {
  return std::to_integer<int>(frame.bytes[kWidth * 20 + 30]);
}

// As one of several cameras, whose others go on.
TEST(VideoFeed, ReportsWhyItBrokeOff) {
  const testing::ScratchFolder folder;
  const auto first = make_video(folder, 8);
  const auto second = folder / "second.mkv";
  std::filesystem::copy_file(first, second);
  const auto feed =
      open({.name = "left", .path = first, .then = {{.path = second}}, .buffers = 1});
  EXPECT_EQ(feed->health().state, capture::CameraState::kStreaming);
  std::filesystem::remove(second);  // It waits for a reader before it comes to that.
  feed->begin_at(now());
  while (!feed->is_over()) (void)feed->next(milliseconds(100));
  EXPECT_EQ(feed->health().state, capture::CameraState::kLost);
  EXPECT_NE(feed->health().trouble.find("second.mkv"), std::string::npos);
}

TEST(VideoFeed, GivesEveryFrameAtItsInstantAndEnds) {
  const testing::ScratchFolder folder;
  const auto feed = open({.name = "left", .path = make_video(folder, 8), .buffers = 8});
  EXPECT_EQ(feed->settings().width_px, kWidth);
  EXPECT_EQ(feed->settings().format, capture::PixelFormat::kGrey);
  EXPECT_FALSE(feed->next(milliseconds(1))) << "the feed was not started";
  const Timestamp begin = now() + milliseconds(20);
  feed->begin_at(begin);
  for (int k = 0; k < 8; ++k) {
    const auto frame = feed->next(milliseconds(60000));
    ASSERT_TRUE(frame) << k;
    EXPECT_EQ(frame->time, begin + milliseconds(10 * k));
    EXPECT_GE(now(), frame->time) << "no frame is delivered before its time";
    EXPECT_NEAR(grey_of(*frame), 20 * k, 2);
    EXPECT_EQ(frame->sequence, static_cast<std::uint32_t>(k));
    EXPECT_EQ(frame->dropped_before, 0);
  }
  EXPECT_TRUE(feed->is_over());
  EXPECT_FALSE(feed->next(milliseconds(1)));
}

TEST(VideoFeed, DropsTheOldestUnfetchedFramesAndCountsThem) {
  const testing::ScratchFolder folder;
  const auto feed = open({.name = "left", .path = make_video(folder, 10), .buffers = 2});
  // All of them are due; no more than two wait.
  feed->begin_at(now() - std::chrono::seconds(10));
  int got = 0;
  int dropped = 0;
  while (!feed->is_over()) {
    const auto frame = feed->next(milliseconds(60000));
    if (!frame) continue;
    ++got;
    dropped += frame->dropped_before;
    std::this_thread::sleep_for(milliseconds(5));
  }
  EXPECT_EQ(got + dropped, 10);
  EXPECT_GT(dropped, 0);
}

TEST(VideoFeed, PlaysARangeOverAndOver) {
  const testing::ScratchFolder folder;
  capture::VideoFeedOptions options{.name = "left", .path = make_video(folder, 6)};
  options.first_frame = 2;
  options.last_frame = 4;
  options.loop = true;
  options.buffers = 100;
  const auto feed = open(options);
  feed->begin_at(now());
  for (int k = 0; k < 9; ++k) {
    const auto frame = feed->next(milliseconds(60000));
    ASSERT_TRUE(frame);
    EXPECT_NEAR(grey_of(*frame), 20 * (2 + k % 3), 2) << k;
    EXPECT_EQ(frame->sequence, static_cast<std::uint32_t>(k));
  }
  EXPECT_FALSE(feed->is_over());
}

TEST(VideoFeed, PlaysOneVideoAfterTheOther) {
  const testing::ScratchFolder first;
  const testing::ScratchFolder second;
  capture::VideoFeedOptions options{.name = "left", .path = make_video(first, 2)};
  options.then = {{make_video(second, 6), 3, 4}};
  options.loop = true;
  options.buffers = 100;
  const auto feed = open(options);
  feed->begin_at(now());
  constexpr std::array kShown{0, 1, 3, 4};
  for (std::size_t k = 0; k < 9; ++k) {
    const auto frame = feed->next(milliseconds(60000));
    ASSERT_TRUE(frame);
    EXPECT_NEAR(grey_of(*frame), 20 * kShown[k % 4], 2) << k;
    EXPECT_EQ(frame->sequence, static_cast<std::uint32_t>(k));
  }
}

TEST(VideoFeed, RejectsOtherFilesAndRangesBeyondTheEnd) {
  const testing::ScratchFolder folder;
  EXPECT_FALSE(
      capture::VideoFeed::open({.name = "left", .path = folder / "nothing.mkv"}));
  capture::VideoFeedOptions options{.name = "left", .path = make_video(folder, 3)};
  options.first_frame = 3;
  const auto late = capture::VideoFeed::open(options);
  ASSERT_FALSE(late);
  EXPECT_NE(late.error().cause.find("ends before frame 3"), std::string::npos);
}

}  // namespace
}  // namespace marey::app
