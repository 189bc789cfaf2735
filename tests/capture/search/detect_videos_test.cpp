// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/search/detect_videos.h"

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/base/frame_range.h"
#include "tests/capture/scratch_video.h"
#include "tests/capture/tag_artist.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::capture {
namespace {

using testing::ScratchFolder;

/// A folder of `frames` images in which tag `id` moves to the right, 5 px a frame; it is
/// missing from frame 2.
CameraInput moving_tag(const ScratchFolder& scratch,
                       const std::string& name,
                       int id,
                       int frames) {
  std::filesystem::create_directories(scratch / name);
  for (int i = 0; i < frames; ++i) {
    std::vector<tests::DrawnTag> tags;
    if (i != 2) tags.push_back({"tag36h11", id, tests::square({60.0 + 5 * i, 50}, 50)});
    cv::imwrite(((scratch / name) / (std::to_string(i) + ".png")).string(),
                tests::draw_tags(160, 100, tags));
  }
  CameraInput input;
  input.path = scratch / name;
  input.camera = CameraId{id};
  input.name = "trial/" + name;
  input.rate = FrameRate{50.0};
  return input;
}

std::vector<CameraInput> three_cameras(const ScratchFolder& scratch) {
  return {moving_tag(scratch, "a", 0, 4),
          moving_tag(scratch, "b", 1, 6),
          moving_tag(scratch, "c", 2, 5)};
}

/// Returns every frame with a detected tag, and the position of its first corner, as one
/// comparable list.
std::vector<double> flattened(const std::vector<CameraDetections>& cameras) {
  std::vector<double> all;
  for (const CameraDetections& camera : cameras) {
    for (const FrameDetections& frame : camera.frames) {
      all.push_back(frame.frame);
      for (const TagDetection& tag : frame.tags) {
        all.push_back(number(tag.id));
        for (const auto& c : tag.corners_px) all.insert(all.end(), {c.x, c.y});
      }
    }
  }
  return all;
}

void break_image(const CameraInput& input, int frame) {
  std::ofstream(input.path / (std::to_string(frame) + ".png")) << "broken\n";
}

TEST(DetectVideos, FillsInEverythingAboutACamera) {
  const ScratchFolder scratch;
  CameraInput input = moving_tag(scratch, "a", 3, 4);
  input.offset = Timestamp{7'300'000};
  const auto cameras = detect_tags_in_videos(std::vector{input});
  ASSERT_TRUE(cameras) << cameras.error().message();
  const CameraDetections& camera = cameras->at(0);
  EXPECT_EQ(camera.source, "trial/a");
  EXPECT_EQ(camera.camera, CameraId{3});
  EXPECT_EQ(camera.width_px, 160);
  EXPECT_EQ(camera.height_px, 100);
  EXPECT_EQ(camera.rate.hz, 50.0);
  EXPECT_EQ(camera.offset->count(), 7'300'000);
}

TEST(DetectVideos, KeepsFramesWithoutTags) {
  const ScratchFolder scratch;
  const auto cameras = detect_tags_in_videos(std::vector{moving_tag(scratch, "a", 3, 4)});
  ASSERT_TRUE(cameras) << cameras.error().message();
  std::vector<std::size_t> tags_seen;
  for (const auto& frame : cameras->at(0).frames) tags_seen.push_back(frame.tags.size());
  EXPECT_EQ(tags_seen, (std::vector<std::size_t>{1, 1, 0, 1}));
}

TEST(DetectVideos, TakesTheRateOfAVideoFromItsContainer) {
  const ScratchFolder scratch;
  tests::write_video(scratch / "a.mp4", 3);
  CameraInput input;
  input.path = scratch / "a.mp4";
  const auto cameras = detect_tags_in_videos(std::vector{input});
  ASSERT_TRUE(cameras) << cameras.error().message();
  EXPECT_DOUBLE_EQ(cameras->at(0).rate.hz, 25.0);
}

TEST(DetectVideos, NumbersTheFramesOfARangeAsInTheWholeRecording) {
  const ScratchFolder scratch;
  CameraInput input = moving_tag(scratch, "a", 3, 6);
  input.range = FrameRange{3, 4};
  const auto cameras = detect_tags_in_videos(std::vector{input});
  ASSERT_TRUE(cameras) << cameras.error().message();
  const auto& frames = cameras->at(0).frames;
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].frame, 3);
  EXPECT_EQ(frames[1].frame, 4);
}

TEST(DetectVideos, FindsTheSameWithAnyNumberOfWorkers) {
  const ScratchFolder scratch;
  const auto inputs = three_cameras(scratch);
  const auto alone = detect_tags_in_videos(inputs, {.tracker = {}, .workers = 1});
  ASSERT_TRUE(alone) << alone.error().message();
  for (const int workers : {2, 3, 8}) {
    const auto shared =
        detect_tags_in_videos(inputs, {.tracker = {}, .workers = workers});
    ASSERT_TRUE(shared) << shared.error().message();
    EXPECT_EQ(flattened(*shared), flattened(*alone)) << workers << " workers";
  }
}

TEST(DetectVideos, ReportsTheErrorOfTheFirstCameraThatFails) {
  const ScratchFolder scratch;
  const auto inputs = three_cameras(scratch);
  break_image(inputs[1], 5);  // Late in the second, early in the third.
  break_image(inputs[2], 1);
  for (const int workers : {1, 3}) {
    const auto cameras =
        detect_tags_in_videos(inputs, {.tracker = {}, .workers = workers});
    ASSERT_FALSE(cameras);
    EXPECT_EQ(cameras.error().where, "trial/b/5.png") << workers << " workers";
  }
}

TEST(DetectVideos, CountsEveryFrameOfEveryCameraOnce) {
  const ScratchFolder scratch;
  const auto inputs = three_cameras(scratch);
  std::vector<int> done;
  int last_total = 0;
  const auto cameras = detect_tags_in_videos(
      inputs, {.tracker = {}, .workers = 3}, [&](int now, int total) {
        done.push_back(now);
        last_total = total;
      });
  ASSERT_TRUE(cameras) << cameras.error().message();
  EXPECT_EQ(last_total, 15);
  ASSERT_EQ(done.size(), 15U);
  for (int i = 0; i < 15; ++i) EXPECT_EQ(done[static_cast<std::size_t>(i)], i + 1);
}

// JPEG images in sequence, as sent by network cameras: no header contains their number.
TEST(DetectVideos, ReportsAnUnknownTotalUntilTheEnd) {
  const ScratchFolder scratch;
  {
    std::ofstream film(scratch / "a.mjpeg", std::ios::binary);
    for (int i = 0; i < 7; ++i) {
      std::vector<unsigned char> jpeg;
      cv::imencode(".jpg", tests::draw_tags(160, 100, {}), jpeg);
      film.write(reinterpret_cast<const char*>(jpeg.data()),
                 static_cast<std::streamsize>(jpeg.size()));
    }
  }
  CameraInput input;
  input.path = scratch / "a.mjpeg";
  input.rate = FrameRate{25.0};
  std::vector<std::pair<int, int>> said;
  const auto cameras = detect_tags_in_videos(
      std::vector{input}, {}, [&](int now, int total) { said.emplace_back(now, total); });
  ASSERT_TRUE(cameras) << cameras.error().message();
  ASSERT_EQ(said.size(), 8U);
  for (int i = 0; i < 7; ++i) {
    EXPECT_EQ(said[static_cast<std::size_t>(i)], std::pair(i + 1, kUnknownTotal));
  }
  EXPECT_EQ(said.back(), std::pair(7, 7));
}

TEST(DetectVideos, CountsTheSightingsThatItDropped) {
  const ScratchFolder scratch;
  CameraInput input = moving_tag(scratch, "a", 3, 4);
  cv::imwrite((scratch / "a/0.png").string(),
              tests::draw_tags(160,
                               100,
                               {{"tag36h11", 3, tests::square({40, 50}, 50)},
                                {"tag36h11", 3, tests::square({120, 50}, 50)}}));
  const auto cameras = detect_tags_in_videos(std::vector{input});
  ASSERT_TRUE(cameras) << cameras.error().message();
  EXPECT_EQ(cameras->at(0).dropped.duplicated, 2);
  EXPECT_EQ(cameras->at(0).dropped.unsure, 0);
}

TEST(DetectVideos, RefusesARangeThatTheRecordingDoesNotReach) {
  const ScratchFolder scratch;
  CameraInput input = moving_tag(scratch, "a", 3, 4);
  input.range = FrameRange{2, 9};
  const auto cameras = detect_tags_in_videos(std::vector{input});
  ASSERT_FALSE(cameras);
  EXPECT_EQ(cameras.error().message(),
            "trial/a: frames 2 to 9 are beyond its end: it has only 4. Next: correct the "
            "trial's range of frames.");
}

TEST(DetectVideos, RefusesAFolderWithoutARate) {
  const ScratchFolder scratch;
  CameraInput input = moving_tag(scratch, "a", 3, 1);
  input.rate.reset();
  const auto cameras = detect_tags_in_videos(std::vector{input});
  ASSERT_FALSE(cameras);
  EXPECT_EQ(cameras.error().message(),
            "trial/a: its frames have no rate. Next: give the camera's frames per second "
            "in the session file.");
}

}  // namespace
}  // namespace marey::capture
