// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Tracking and grouping of ten thousand frames keep no frame in memory.
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "capture/sync/group_frames.h"
#include "capture/tags/tag_pattern.h"
#include "capture/tags/track_tags.h"

namespace marey {
namespace {

constexpr int kWidth = 200;
constexpr int kHeight = 150;
constexpr int kCanvasWidth = 300;
constexpr int kCanvasHeight = 225;
constexpr int kCell_px = 4;
constexpr int kCameras = 2;

/// Draws a wall with six tags that is larger than the view of a camera.
std::vector<std::uint8_t> draw_wall() {
  std::vector<std::uint8_t> wall(std::size_t{kCanvasWidth} * kCanvasHeight, 170);
  const std::array<TagId, 6> ids{
      TagId{3}, TagId{11}, TagId{42}, TagId{100}, TagId{200}, TagId{586}};
  const auto patterns = capture::tag_patterns("tag36h11", ids);
  EXPECT_TRUE(patterns);
  for (int t = 0; t < 6; ++t) {
    const TagPattern& pattern = (*patterns)[static_cast<std::size_t>(t)];
    const int left = 40 + 85 * (t % 3);
    const int top = 50 + 75 * (t / 3);
    for (int y = 0; y < pattern.cells * kCell_px; ++y) {
      for (int x = 0; x < pattern.cells * kCell_px; ++x) {
        const int cell = y / kCell_px * pattern.cells + x / kCell_px;
        const bool white = pattern.white[static_cast<std::size_t>(cell)] != 0;
        wall[static_cast<std::size_t>((top + y) * kCanvasWidth + left + x)] =
            white ? 230 : 30;
      }
    }
  }
  return wall;
}

/// Returns the view of a camera that moves over the wall: tags enter and leave the view.
capture::GrayFrame look(const std::vector<std::uint8_t>& wall, int camera, int k) {
  const double turn = 2.0 * std::numbers::pi * (k + 40 * camera) / 300.0;
  const auto place = [](double wave, int room) {
    return static_cast<int>(std::lround(0.5 * room * (1.0 + wave)));
  };
  const int x = place(std::sin(turn), kCanvasWidth - kWidth);
  const int y = place(std::cos(1.7 * turn), kCanvasHeight - kHeight);
  capture::GrayFrame frame;
  frame.pixels = wall.data() + y * kCanvasWidth + x;
  frame.width_px = kWidth;
  frame.height_px = kHeight;
  frame.stride = kCanvasWidth;
  frame.index = k;
  return frame;
}

long peak_kb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

// Measures the peak of the whole process. Kept frames would exceed the limit: a tag's
// corners take 100 bytes, so 9,000 frames of a few tags take some MB.
TEST(Memory, StaysFlatWhileTenThousandFramesAreTrackedAndGrouped) {
  const std::vector<std::uint8_t> wall = draw_wall();
  std::vector<capture::TagTracker> trackers;
  for (int c = 0; c < kCameras; ++c) {
    auto tracker = capture::TagTracker::create();
    ASSERT_TRUE(tracker);
    trackers.push_back(std::move(*tracker));
  }
  const std::vector<capture::ClockModel> clocks(kCameras);
  capture::GroupFramesOptions options;
  capture::FrameGrouper grouper(clocks, options);
  long seen = 0;
  long groups = 0;
  long after_1000_kb = 0;
  for (int k = 0; k < 10000 / kCameras; ++k) {
    for (int c = 0; c < kCameras; ++c) {
      const auto& tags = trackers[static_cast<std::size_t>(c)].track(look(wall, c, k));
      seen += static_cast<long>(tags.size());
      const capture::Offer offer = grouper.offer(
          CameraId{c}, frame_time(k, options.rate), capture::FrameTicket{k});
      ASSERT_FALSE(offer.refused);
    }
    while (grouper.next()) ++groups;
    if (k * kCameras == 1000) after_1000_kb = peak_kb();
  }
  EXPECT_GT(seen, 10000);  // Tags are found, and followed.
  EXPECT_GT(groups, 4900);
  const long grown_kb = peak_kb() - after_1000_kb;
  RecordProperty("grown_kb", static_cast<int>(grown_kb));
  EXPECT_LT(grown_kb, 1024) << "from " << after_1000_kb << " kB";
}

}  // namespace
}  // namespace marey
