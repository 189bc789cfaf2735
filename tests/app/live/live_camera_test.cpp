// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Thumbnails of the cameras' pictures, and the requests of pages for them.
#include "capture/feeds/live_camera.h"

#include <gtest/gtest.h>

#include "app/live/thumbnail_requests.h"
#include "recordings/takes/jpeg_encoder.h"
#include "tests/app/synthetic_feed.h"

namespace marey::app {
namespace {

// 1284 / 4, 1366 / 4, 606 / 4 and 404 / 4 are odd, and a JPEG's width here is not.
TEST(LiveCamera, ShrinksPicturesOfAnyWidthToThumbnails) {
  for (const int width_px : {1280, 1284, 1366, 606, 404, 6}) {
    constexpr int kHeight = 90;
    testing::SyntheticFeed feed(0, {});
    feed.settings_to_spoil().format = capture::PixelFormat::kGrey;
    feed.settings_to_spoil().width_px = width_px;
    feed.settings_to_spoil().height_px = kHeight;
    feed.settings_to_spoil().stride = width_px;
    Camera camera;
    camera.intrinsics.width_px = width_px;
    camera.intrinsics.height_px = kHeight;
    capture::LiveCameraOptions options;
    options.stale_after_s = 1e9;
    auto live = capture::LiveCamera::create(options, camera, feed, {});
    ASSERT_TRUE(live) << live.error().message();
    (*live)->want_thumbnails(true);
    const std::vector<std::byte> pixels(static_cast<std::size_t>(width_px * kHeight),
                                        std::byte{90});
    capture::RawFrame frame;
    frame.bytes = pixels;
    frame.time = std::chrono::steady_clock::now().time_since_epoch();
    capture::DetectedPicture out;
    ASSERT_TRUE((*live)->make(frame, out)) << width_px;
    EXPECT_EQ(out.thumbnail_width_px % 2, 0) << width_px;
    EXPECT_LE(width_px - 4 * out.thumbnail_width_px, 7);
    EXPECT_EQ(out.thumbnail.size(),
              static_cast<std::size_t>(out.thumbnail_width_px * out.thumbnail_height_px));
    if (out.thumbnail.empty()) continue;
    auto encoder = recordings::JpegEncoder::create(recordings::RawLayout::kGrey,
                                                   out.thumbnail_width_px,
                                                   out.thumbnail_height_px,
                                                   out.thumbnail_width_px);
    ASSERT_TRUE(encoder);
    EXPECT_FALSE(encoder->encode(out.thumbnail).empty()) << width_px;
  }
}

TEST(ThumbnailRequests, AreNotEndedByAnotherPage) {
  ThumbnailRequests wishes;
  wishes.ask(live::ClientId{1}, true);
  wishes.ask(live::ClientId{2}, false);
  EXPECT_TRUE(wishes.any());
  wishes.ask(live::ClientId{1}, false);
  EXPECT_FALSE(wishes.any());
  wishes.ask(live::ClientId{3}, true);
  wishes.reset();
  EXPECT_FALSE(wishes.any());
}

}  // namespace
}  // namespace marey::app
