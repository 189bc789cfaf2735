// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// The grey images are those of OpenCV's own readers, bit by bit.
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "capture/video/open_frames.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::capture {
namespace {

using testing::ScratchFolder;

/// Returns the number of pixels of the next frame that differ from `expected`.
int different_pixels(FrameSource& source, const cv::Mat& expected) {
  const auto next = source.next();
  if (!next || !*next) return -1;
  const GrayFrame& frame = **next;
  const cv::Mat gray(frame.height_px,
                     frame.width_px,
                     CV_8UC1,
                     const_cast<std::uint8_t*>(frame.pixels),
                     static_cast<std::size_t>(frame.stride));
  if (gray.size() != expected.size()) return -1;
  return cv::countNonZero(gray != expected);
}

TEST(OpenCvGrey, IsThatOfAVideo) {
  const auto path =
      marey::testing::source_dir() / "recordings/samples/first-light/calib/cam0.mp4";
  const auto source = open_frames(path);
  ASSERT_TRUE(source);
  cv::VideoCapture theirs(path.string(), cv::CAP_FFMPEG);
  cv::Mat colour;
  cv::Mat gray;
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(theirs.read(colour));
    cv::cvtColor(colour, gray, cv::COLOR_BGR2GRAY);
    EXPECT_EQ(different_pixels(**source, gray), 0) << i;
  }
}

TEST(OpenCvGrey, IsThatOfImages) {
  cv::Mat noise(47, 61, CV_8UC3);
  cv::RNG random(1);
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  for (const std::string name : {"a.png", "a.jpg"}) {
    const ScratchFolder folder;
    ASSERT_TRUE(cv::imwrite((folder / name).string(), noise));
    const auto source = open_frames(folder.path());
    ASSERT_TRUE(source);
    const cv::Mat theirs = cv::imread((folder / name).string(), cv::IMREAD_GRAYSCALE);
    EXPECT_EQ(different_pixels(**source, theirs), 0) << name;
  }
}

}  // namespace
}  // namespace marey::capture
