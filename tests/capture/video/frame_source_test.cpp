// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/video/frame_source.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sys/stat.h>

#include "capture/video/image_folder.h"
#include "capture/video/open_frames.h"
#include "tests/capture/scratch_video.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::capture {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

const fs::path kData = marey::testing::source_dir() / "tests/capture/data";

std::unique_ptr<FrameSource> open(const fs::path& path, const std::string& name = {}) {
  auto source = open_frames(path, name);
  EXPECT_TRUE(source) << source.error().message();
  return source ? std::move(*source) : nullptr;
}

// Opening a pipe must not block.
TEST(OpenFrames, DeclinesPipesAndDevices) {
  const ScratchFolder folder;
  ASSERT_EQ(mkfifo((folder / "cam0.mp4").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder / "cam1.mp4");
  for (const char* name : {"cam0.mp4", "cam1.mp4"}) {
    const auto source = open_frames(folder / name, name);
    ASSERT_FALSE(source) << name;
    EXPECT_EQ(source.error().code, Errc::kBadInput);
    EXPECT_NE(source.error().cause.find("not a file"), std::string::npos)
        << source.error().message();
  }
}

struct ReadThrough {
  std::vector<int> brightness;  ///< Brightness of each frame's middle.
  std::vector<int> indices;
  std::optional<Error> error;
};

ReadThrough read_all(FrameSource& source) {
  ReadThrough all;
  while (true) {
    auto frame = source.next();
    if (!frame) {
      all.error = frame.error();
      return all;
    }
    if (!*frame) return all;
    const GrayFrame& f = **frame;
    all.indices.push_back(f.index);
    all.brightness.push_back(f.pixels[(f.height_px / 2) * f.stride + f.width_px / 2]);
  }
}

/// Expects the frames of scratch_video.h, each once and in order; a codec may be 3 grey
/// levels off.
void expect_frames(const ReadThrough& all, int count) {
  ASSERT_FALSE(all.error) << all.error->message();
  ASSERT_EQ(all.indices.size(), static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    EXPECT_EQ(all.indices[static_cast<std::size_t>(i)], i);
    EXPECT_NEAR(
        all.brightness[static_cast<std::size_t>(i)], tests::brightness_of_frame(i), 3);
  }
}

TEST(VideoFile, GivesEveryFrameOnceInOrder) {
  const ScratchFolder scratch;
  for (const char* name : {"a.mp4", "a.avi", "a.mkv"}) {
    SCOPED_TRACE(name);
    tests::write_video(scratch / name, 20);
    const auto source = open(scratch / name);
    ASSERT_TRUE(source);
    expect_frames(read_all(*source), 20);
  }
}

TEST(VideoFile, ReportsSizeRateAndExpectedFrames) {
  const ScratchFolder scratch;
  tests::write_video(scratch / "a.mp4", 20);
  const auto source = open(scratch / "a.mp4", "walk/a.mp4");
  ASSERT_TRUE(source);
  EXPECT_EQ(source->info().name, "walk/a.mp4");
  EXPECT_EQ(source->info().width_px, 64);
  EXPECT_EQ(source->info().height_px, 48);
  ASSERT_TRUE(source->info().rate);
  EXPECT_DOUBLE_EQ(source->info().rate->hz, 25.0);
  EXPECT_EQ(source->info().expected_frames, 20);
}

TEST(VideoFile, ReadsARealVideoToItsEnd) {
  const auto source = open(kData / "index_first.mp4");
  ASSERT_TRUE(source);
  const ReadThrough all = read_all(*source);
  EXPECT_FALSE(all.error) << all.error->message();
  EXPECT_EQ(all.indices.size(), 40U);
}

TEST(VideoFile, AcceptsAVideoTrimmedByAnEditList) {
  const auto source = open(kData / "trimmed.mp4");
  ASSERT_TRUE(source);
  const ReadThrough all = read_all(*source);
  EXPECT_FALSE(all.error) << all.error->message();
  EXPECT_EQ(all.indices.size(), 25U);
  EXPECT_EQ(source->info().expected_frames, 25);
}

TEST(VideoFile, ReportsHowManyFramesATruncatedVideoContains) {
  const ScratchFolder scratch;
  fs::copy_file(kData / "index_first.mp4", scratch / "cut.mp4");
  tests::truncate(scratch / "cut.mp4", 0.9);
  const auto source = open(scratch / "cut.mp4", "walk/cam2.mp4");
  ASSERT_TRUE(source);
  const ReadThrough all = read_all(*source);
  ASSERT_TRUE(all.error);
  EXPECT_EQ(all.error->code, Errc::kBadInput);
  EXPECT_EQ(all.error->message(),
            "walk/cam2.mp4: the video ends after " + std::to_string(all.indices.size()) +
                " of 40 frames. Next: copy the file from the camera again.");
}

TEST(VideoFile, NoticesATruncatedVideoOfAContainerThatCountsRoughly) {
  const ScratchFolder scratch;
  tests::write_video(scratch / "cut.avi", 60);
  tests::truncate(scratch / "cut.avi", 0.5);
  const auto source = open(scratch / "cut.avi");
  ASSERT_TRUE(source);
  const ReadThrough all = read_all(*source);
  ASSERT_TRUE(all.error);
  EXPECT_NE(all.error->cause.find("of 60 frames"), std::string::npos) << all.error->cause;
}

TEST(VideoFile, RefusesAnMp4WithoutItsIndex) {
  const ScratchFolder scratch;
  tests::write_video(scratch / "cut.mp4", 20);
  tests::truncate(scratch / "cut.mp4", 0.5);
  const auto source = open_frames(scratch / "cut.mp4", "walk/cam2.mp4");
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Errc::kBadInput);
  EXPECT_EQ(source.error().where, "walk/cam2.mp4");
  EXPECT_EQ(source.error().cause,
            "it cannot be opened as a video: it is not one, or its index is missing "
            "because the copy or the recording was cut short");
}

TEST(VideoFile, RefusesAFileThatIsNoVideo) {
  const ScratchFolder scratch;
  std::ofstream(scratch / "notes.mp4") << "not a video\n";
  EXPECT_FALSE(open_frames(scratch / "notes.mp4"));
}

// A user must see marey's one sentence and no messages of the libraries.
TEST(VideoFile, LeavesStandardErrorSilentAboutABrokenVideo) {
  const ScratchFolder scratch;
  std::ofstream(scratch / "notes.mp4") << "not a video\n";
  fs::copy_file(kData / "index_first.mp4", scratch / "cut.mp4");
  tests::truncate(scratch / "cut.mp4", 0.9);
  ::testing::internal::CaptureStderr();
  EXPECT_FALSE(open_frames(scratch / "notes.mp4"));
  const auto source = open(scratch / "cut.mp4");
  ASSERT_TRUE(source);
  EXPECT_TRUE(read_all(*source).error);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(OpenFrames, NamesAMissingFile) {
  const auto source = open_frames("/nowhere/cam9.mp4");
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().message(),
            "/nowhere/cam9.mp4: the video or folder does not exist. Next: check the name "
            "and the folder.");
}

TEST(NaturalOrder, CountsAsAPersonDoes) {
  std::vector<std::string> names{"f10.png",
                                 "f9.png",
                                 "f009.png",
                                 "g1.png",
                                 "f1b.png",
                                 "f1.png",
                                 "f.png",
                                 "f1a2.png",
                                 "f1a10.png"};
  std::sort(names.begin(), names.end(), natural_less);
  const std::vector<std::string> expected{"f.png",
                                          "f1.png",
                                          "f1a2.png",
                                          "f1a10.png",
                                          "f1b.png",
                                          "f009.png",
                                          "f9.png",
                                          "f10.png",
                                          "g1.png"};
  EXPECT_EQ(names, expected);
}

TEST(ImageFolder, GivesItsImagesInNaturalOrder) {
  const ScratchFolder scratch;
  tests::write_images(scratch.path(), 12);  // f9.png before f10.png.
  std::ofstream(scratch / "notes.txt") << "not an image\n";
  const auto source = open(scratch.path());
  ASSERT_TRUE(source);
  EXPECT_FALSE(source->info().rate);
  EXPECT_EQ(source->info().expected_frames, 12);
  expect_frames(read_all(*source), 12);
}

TEST(ImageFolder, RefusesAFolderWithoutImages) {
  const ScratchFolder scratch;
  const auto source = open_frames(scratch.path(), "cam0");
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().message(),
            "cam0: the folder has no .png or .jpg images. Next: name a video file or a "
            "folder with the frames as images.");
}

TEST(ImageFolder, NamesAnImageThatWasCutShort) {
  for (const char* kind : {".png", ".jpg"}) {
    const ScratchFolder scratch;
    const std::string broken = std::string("f2") + kind;
    tests::write_images(scratch.path(), 2);
    cv::Mat noise(200, 300, CV_8UC3);
    cv::randu(noise, 0, 255);
    cv::imwrite((scratch / broken).string(), noise);
    tests::truncate(scratch / broken, 0.5);
    ::testing::internal::CaptureStderr();
    const auto source = open(scratch.path(), "cam0");
    ASSERT_TRUE(source);
    const ReadThrough all = read_all(*source);
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    ASSERT_TRUE(all.error) << kind;
    EXPECT_EQ(all.error->where, "cam0/" + broken);
    EXPECT_EQ(all.error->cause, "the image cannot be read");
  }
}

TEST(ImageFolder, NamesAnImageOfAnotherSize) {
  const ScratchFolder scratch;
  tests::write_images(scratch.path(), 2);
  cv::imwrite((scratch / "f2.png").string(), cv::Mat(50, 70, CV_8UC1, cv::Scalar(9)));
  const auto source = open(scratch.path(), "cam0");
  ASSERT_TRUE(source);
  const ReadThrough all = read_all(*source);
  ASSERT_TRUE(all.error);
  EXPECT_EQ(all.error->message(),
            "cam0/f2.png: the image is 70x50, the first one is 64x48. Next: keep only "
            "images of one camera and size in the folder.");
}

}  // namespace
}  // namespace marey::capture
