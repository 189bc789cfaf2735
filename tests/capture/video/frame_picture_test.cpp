// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/video/frame_picture.h"

#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/capture/scratch_video.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::capture {
namespace {

using testing::ScratchFolder;

cv::Mat decoded(const std::vector<std::byte>& jpeg) {
  const auto* bytes = reinterpret_cast<const uchar*>(jpeg.data());
  return cv::imdecode(std::vector<uchar>(bytes, bytes + jpeg.size()), cv::IMREAD_COLOR);
}

// The grey value identifies the frame; two codecs may be 5 levels off.
void expect_frame(const FramePicture& picture, int frame) {
  EXPECT_EQ(picture.frame, frame);
  EXPECT_NEAR(cv::mean(decoded(picture.jpeg))[0], tests::brightness_of_frame(frame), 5.0);
}

TEST(ReadPictures, GivesTheFramesOfAVideoInTheOrderAsked) {
  const ScratchFolder scratch;
  tests::write_video(scratch / "a.mp4", 20);
  const std::array frames{13, 2, 13, 19};
  const auto pictures = read_pictures(scratch / "a.mp4", frames);
  ASSERT_TRUE(pictures) << pictures.error().message();
  ASSERT_EQ(pictures->size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) expect_frame((*pictures)[i], frames[i]);
}

TEST(ReadPictures, GivesTheFramesOfAFolder) {
  const ScratchFolder scratch;
  tests::write_images(scratch.path(), 12);
  const std::array frames{10, 9};
  const auto pictures = read_pictures(scratch.path(), frames);
  ASSERT_TRUE(pictures) << pictures.error().message();
  for (std::size_t i = 0; i < 2; ++i) expect_frame((*pictures)[i], frames[i]);
}

TEST(ReadPictures, KeepsColours) {
  const ScratchFolder scratch;
  const cv::Scalar orange(20, 120, 230);
  cv::imwrite((scratch / "a.png").string(), cv::Mat(40, 60, CV_8UC3, orange));
  const auto jpeg = jpeg_of_frame(scratch.path(), 0);
  ASSERT_TRUE(jpeg) << jpeg.error().message();
  const cv::Scalar mean = cv::mean(decoded(*jpeg));
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(mean[i], orange[i], 4.0);
}

TEST(ReadPictures, ScalesWidePicturesAndReportsTheScale) {
  const ScratchFolder scratch;
  tests::write_images(scratch.path(), 1);
  const std::array frames{0};
  const auto pictures = read_pictures(scratch.path(), frames, {.max_width_px = 32});
  ASSERT_TRUE(pictures) << pictures.error().message();
  const FramePicture& picture = pictures->front();
  EXPECT_EQ(picture.width_px, 32);
  EXPECT_EQ(picture.height_px, 24);
  EXPECT_DOUBLE_EQ(picture.scale, 0.5);
  EXPECT_EQ(decoded(picture.jpeg).size(), cv::Size(32, 24));
}

TEST(ReadPictures, RefusesAFrameAfterTheEnd) {
  const ScratchFolder scratch;
  tests::write_video(scratch / "a.mp4", 5);
  const std::array frames{1, 5};
  const auto pictures = read_pictures(scratch / "a.mp4", frames, {}, "walk/a.mp4");
  ASSERT_FALSE(pictures);
  EXPECT_EQ(pictures.error().message(),
            "walk/a.mp4: there is no frame 5, it has 5, counted from 0. Next: choose an "
            "earlier frame.");
}

TEST(ReadPictures, NamesAMissingFile) {
  const auto jpeg = jpeg_of_frame("/nowhere/a.mp4", 0);
  ASSERT_FALSE(jpeg);
  EXPECT_EQ(jpeg.error().cause, "the video or folder does not exist");
}

}  // namespace
}  // namespace marey::capture
