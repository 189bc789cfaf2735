// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Videos as cameras, cables and disks spoil them.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "capture/search/detect_videos.h"
#include "capture/video/frame_source.h"
#include "capture/video/open_frames.h"
#include "tests/capture/scratch_video.h"
#include "tests/support/files/text_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::capture {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

void put(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// Zeros some JPEG images from the given offset to their ends: if only the tables were
/// damaged, those of the previous image would be used.
void spoil(const fs::path& path, const std::vector<int>& pictures, std::size_t from) {
  std::string bytes = testing::read_text(path);
  std::vector<std::size_t> starts;
  for (std::size_t at = bytes.find("\xFF\xD8\xFF"); at != std::string::npos;
       at = bytes.find("\xFF\xD8\xFF", at + 1)) {
    starts.push_back(at);
  }
  for (const int k : pictures) {
    const std::size_t begin = starts.at(static_cast<std::size_t>(k)) + from;
    const std::size_t length = bytes.find("\xFF\xD9", begin) - begin;
    bytes.replace(begin, length, length, '\0');
  }
  put(path, bytes);
}

struct Reading {
  std::vector<int> damaged;
  int frames = 0;
  std::optional<Error> error;
};

Reading read(const fs::path& path) {
  Reading reading;
  auto source = open_frames(path, "walk/cam1");
  if (!source) {
    reading.error = source.error();
    return reading;
  }
  while (true) {
    auto frame = (*source)->next();
    if (!frame) {
      reading.error = frame.error();
      return reading;
    }
    if (!*frame) return reading;
    EXPECT_EQ((*frame)->index, reading.frames);
    if ((*frame)->damaged) {
      reading.damaged.push_back(reading.frames);
    } else {
      EXPECT_NEAR((*frame)->pixels[0], tests::brightness_of_frame(reading.frames), 3);
    }
    ++reading.frames;
  }
}

TEST(BrokenVideo, WithDamagedJpegFramesLosesTheseAlone) {
  const ScratchFolder folder;
  for (const char* name : {"a.avi", "a.mkv"}) {
    tests::write_video(folder / name, 30);
    spoil(folder / name, {0, 7, 29}, 2);
    const Reading reading = read(folder / name);
    EXPECT_FALSE(reading.error) << reading.error->message();
    EXPECT_EQ(reading.frames, 30) << name;
    EXPECT_EQ(reading.damaged, (std::vector<int>{0, 7, 29})) << name;
  }
}

TEST(BrokenVideo, IsRejectedWhenEveryFrameIsDamaged) {
  const ScratchFolder folder;
  tests::write_video(folder / "a.avi", 12);
  std::vector<int> all(12);
  std::iota(all.begin(), all.end(), 0);
  spoil(folder / "a.avi", all, 4);  // All but the marks that identify JPEG.
  const Reading reading = read(folder / "a.avi");
  EXPECT_EQ(reading.frames, 12);
  ASSERT_TRUE(reading.error);
  EXPECT_EQ(
      reading.error->message(),
      "walk/cam1: not one of its 12 frames can be decoded. Next: copy the file from "
      "the camera again.");
}

TEST(BrokenVideo, ThatIsEmptyIsRefused) {
  const ScratchFolder folder;
  for (const char* name : {"a.avi", "a.mkv", "a.mp4"}) {
    put(folder / name, "");
    const Reading reading = read(folder / name);
    ASSERT_TRUE(reading.error) << name;
    EXPECT_EQ(reading.error->code, Errc::kBadInput);
    EXPECT_EQ(reading.error->where, "walk/cam1");
    EXPECT_EQ(reading.error->cause, "the file is empty");
  }
}

/// Writes a Matroska video whose first half is 64x48 and whose second is 128x96: JPEG
/// images contain their own size.
void write_growing_video(const fs::path& folder, const fs::path& to) {
  tests::write_video(folder / "small.avi", 20);
  const std::string small = testing::read_text(folder / "small.avi");
  cv::VideoWriter large((folder / "large.avi").string(),
                        cv::CAP_FFMPEG,
                        cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                        25.0,
                        {128, 96});
  for (int i = 0; i < 20; ++i) large.write(cv::Mat(96, 128, CV_8UC3, cv::Scalar::all(9)));
  large.release();
  // A list for ffmpeg's concat demuxer, which copies packets.
  std::ofstream(folder / "list.txt") << "file small.avi\nfile large.avi\n";
  const std::string command = "ffmpeg -v quiet -f concat -i '" +
                              (folder / "list.txt").string() + "' -c copy '" +
                              to.string() + "'";
  // NOLINTNEXTLINE(concurrency-mt-unsafe)
  ASSERT_EQ(std::system(command.c_str()), 0);
}

TEST(BrokenVideo, ReportsTheFrameWhereItsSizeChanges) {
  if (!fs::exists("/usr/bin/ffmpeg")) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  const ScratchFolder folder;
  write_growing_video(folder.path(), folder / "a.mkv");
  const Reading reading = read(folder / "a.mkv");
  EXPECT_EQ(reading.frames, 20);
  ASSERT_TRUE(reading.error);
  EXPECT_EQ(
      reading.error->message(),
      "walk/cam1: frame 20: the picture changes its size to 128x96, the video began "
      "with 64x48. Next: record with one size, or cut the video there.");
}

CameraInput input(const fs::path& path, int camera) {
  CameraInput one;
  one.path = path;
  one.camera = CameraId{camera};
  one.name = "cam" + std::to_string(camera);
  return one;
}

TEST(BrokenVideo, IsReadAsFarAsItGoesWhenTheRestIsWanted) {
  const ScratchFolder folder;
  tests::write_video(folder / "whole.avi", 60);
  tests::write_video(folder / "cut.avi", 60);
  tests::truncate(folder / "cut.avi", 0.5);
  put(folder / "empty.avi", "");
  const std::vector<CameraInput> inputs{input(folder / "cut.avi", 0),
                                        input(folder / "empty.avi", 1),
                                        input(folder / "whole.avi", 2)};
  DetectVideosOptions options;
  EXPECT_FALSE(detect_tags_in_videos(inputs, options));
  options.keep_broken = true;
  const auto found = detect_tags_in_videos(inputs, options);
  ASSERT_TRUE(found) << found.error().message();
  ASSERT_EQ(found->size(), 3U);
  const CameraDetections& cut = found->at(0);
  EXPECT_GT(cut.frames.size(), 10U);
  EXPECT_LT(cut.frames.size(), 40U);
  ASSERT_TRUE(cut.broken_off);
  EXPECT_EQ(
      cut.broken_off->cause,
      "the video ends after " + std::to_string(cut.frames.size()) + " of 60 frames");
  EXPECT_TRUE(found->at(1).frames.empty());
  ASSERT_TRUE(found->at(1).broken_off);
  EXPECT_EQ(found->at(1).broken_off->where, "cam1");
  EXPECT_EQ(found->at(2).frames.size(), 60U);
  EXPECT_FALSE(found->at(2).broken_off);
}

TEST(BrokenVideo, CountsItsDamagedFrames) {
  const ScratchFolder folder;
  tests::write_video(folder / "a.mkv", 20);
  spoil(folder / "a.mkv", {3, 4}, 2);
  const auto found =
      detect_tags_in_videos(std::vector<CameraInput>{input(folder / "a.mkv", 0)});
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_EQ(found->at(0).frames.size(), 20U);
  EXPECT_EQ(found->at(0).damaged_frames, 2);
}

}  // namespace
}  // namespace marey::capture
