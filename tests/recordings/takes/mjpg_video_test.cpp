// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/takes/mjpg_video.h"

#include <cmath>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "recordings/takes/jpeg_encoder.h"
#include "recordings/takes/video_times.h"
#include "tests/support/files/video_packets.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;
using testing::kFfmpeg;
using testing::run_program;
using testing::ScratchFolder;

constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// Brightness of pixel x, y of picture k.
std::uint8_t luma(int x, int y, int k) {
  return static_cast<std::uint8_t>(16 + (2 * x + y + 5 * k) % 200);
}

std::vector<std::byte> raw_picture(RawLayout layout, int k, int stride) {
  const int rows = layout == RawLayout::kNv12 ? kHeight + kHeight / 2 : kHeight;
  std::vector<std::byte> raw(static_cast<std::size_t>(rows * stride), std::byte{128});
  const int step = layout == RawLayout::kYuyv ? 2 : 1;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      raw[static_cast<std::size_t>(y * stride + step * x)] = std::byte{luma(x, y, k)};
    }
  }
  return raw;
}

std::vector<std::byte> jpeg_of(int k) {
  auto encoder = JpegEncoder::create(RawLayout::kGrey, kWidth, kHeight, kWidth);
  EXPECT_TRUE(encoder);
  const auto jpeg = encoder->encode(raw_picture(RawLayout::kGrey, k, kWidth));
  return {jpeg.begin(), jpeg.end()};
}

MjpgVideoOptions small() {
  MjpgVideoOptions options;
  options.width_px = kWidth;
  options.height_px = kHeight;
  return options;
}

std::string joined(const std::vector<std::vector<std::byte>>& pictures) {
  std::string all;
  for (const auto& picture : pictures) {
    all.append(reinterpret_cast<const char*>(picture.data()), picture.size());
  }
  return all;
}

TEST(MjpgVideo, KeepsEveryPictureByteForByte) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  const ScratchFolder folder;
  auto video = MjpgVideo::create(folder / "a.mkv", small());
  ASSERT_TRUE(video) << video.error().message();
  std::vector<std::vector<std::byte>> pictures;
  for (int k = 0; k < 50; ++k) {
    pictures.push_back(jpeg_of(k));
    ASSERT_TRUE(video->write(pictures.back(), std::chrono::milliseconds(33 * k)));
  }
  ASSERT_TRUE(video->finish());
  EXPECT_EQ(testing::video_packets(folder / "a.mkv"), joined(pictures));
}

TEST(MjpgVideo, ThatWasCutOffIsReadUpToItsLastMoments) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  const ScratchFolder folder;
  std::vector<std::vector<std::byte>> pictures;
  for (int k = 0; k < 60; ++k) pictures.push_back(jpeg_of(k));
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    auto video = MjpgVideo::create(folder / "a.mkv", small());
    for (int k = 0; k < 60; ++k) {
      (void)video->write(pictures[static_cast<std::size_t>(k)],
                         std::chrono::milliseconds(33 * k));
    }
    raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  const std::string read = testing::video_packets(folder / "a.mkv");
  const std::string all = joined(pictures);
  // 0.4 s are 12 frames, and the one that closes the cluster.
  EXPECT_GE(read.size(), all.size() * 46 / 60);
  EXPECT_EQ(read, all.substr(0, read.size()));
}

// The frames before an outage are on the disk although no frame follows.
TEST(MjpgVideo, HasAllOfItsFramesOnceTheyAreFlushed) {
  const ScratchFolder folder;
  auto video = MjpgVideo::create(folder / "a.mkv", small());
  ASSERT_TRUE(video);
  for (int k = 0; k < 5; ++k) {
    ASSERT_TRUE(video->write(jpeg_of(k), std::chrono::milliseconds(33 * k)));
  }
  const auto before = video_times(folder / "a.mkv");
  EXPECT_LT(before ? before->size() : 0, 5U);
  ASSERT_TRUE(video->flush());
  ASSERT_TRUE(video->flush());
  const auto after = video_times(folder / "a.mkv");
  ASSERT_TRUE(after);
  EXPECT_EQ(after->size(), 5U);
  for (int k = 5; k < 10; ++k) {
    ASSERT_TRUE(video->write(jpeg_of(k), std::chrono::milliseconds(33 * k)));
  }
  ASSERT_TRUE(video->finish());
  EXPECT_EQ(video_times(folder / "a.mkv")->size(), 10U);
}

/// Changes the working folder during its lifetime.
class InFolder {
 public:
  explicit InFolder(const fs::path& folder) { fs::current_path(folder); }
  ~InFolder() { fs::current_path(before_); }
  InFolder(const InFolder&) = delete;
  InFolder& operator=(const InFolder&) = delete;

 private:
  fs::path before_ = fs::current_path();
};

// FFmpeg interprets names as URLs.
TEST(MjpgVideo, MayHaveAnyName) {
  const ScratchFolder folder;
  const InFolder here(folder.path());
  for (const char* name : {"take-11:56", "pipe:1", "a#b", "q?x=1", "50%20"}) {
    fs::create_directories(name);
    const fs::path file = fs::path(name) / "cam0.mkv";
    auto video = MjpgVideo::create(file, small());
    ASSERT_TRUE(video) << video.error().message();
    ASSERT_TRUE(video->write(jpeg_of(0), Timestamp{0}));
    ASSERT_TRUE(video->finish());
    EXPECT_TRUE(fs::exists(file));
    const auto times = video_times(file);
    ASSERT_TRUE(times) << name;
    EXPECT_EQ(times->size(), 1U);
  }
}

TEST(MjpgVideo, ReportsAFileThatCannotBeCreated) {
  const ScratchFolder folder;
  const auto video = MjpgVideo::create(folder / "nowhere" / "a.mkv", small());
  ASSERT_FALSE(video);
  EXPECT_EQ(video.error().code, Errc::kDevice);
  EXPECT_NE(video.error().cause.find("No such file"), std::string::npos);
}

// The result is checked with another decoder.
void expect_kept(RawLayout layout, int stride) {
  if (!fs::exists(kFfmpeg)) GTEST_SKIP() << "skipped: apt-get install ffmpeg";
  const ScratchFolder folder;
  auto encoder = JpegEncoder::create(layout, kWidth, kHeight, stride);
  ASSERT_TRUE(encoder) << encoder.error().message();
  auto video = MjpgVideo::create(folder / "a.mkv", small());
  ASSERT_TRUE(video);
  for (int k = 0; k < 5; ++k) {
    const auto jpeg = encoder->encode(raw_picture(layout, k, stride));
    ASSERT_FALSE(jpeg.empty());
    ASSERT_TRUE(video->write(jpeg, std::chrono::milliseconds(33 * k)));
  }
  ASSERT_TRUE(video->finish());
  const auto run = run_program(kFfmpeg,
                               {"-v",
                                "error",
                                "-i",
                                (folder / "a.mkv").string(),
                                "-vf",
                                "extractplanes=y",
                                "-f",
                                "rawvideo",
                                (folder / "a.y").string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::ifstream in(folder / "a.y", std::ios::binary);
  const std::string grey{std::istreambuf_iterator<char>(in), {}};
  ASSERT_EQ(grey.size(), static_cast<std::size_t>(5 * kWidth * kHeight));
  double sum2 = 0.0;
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const int p = static_cast<int>(i);
    const int k = p / (kWidth * kHeight);
    const int y = p / kWidth % kHeight;
    const double d = static_cast<std::uint8_t>(grey[i]) - luma(p % kWidth, y, k);
    sum2 += d * d;
  }
  // Ramps with a step are preserved to about a grey value.
  EXPECT_LT(std::sqrt(sum2 / static_cast<double>(grey.size())), 2.0);
}

TEST(JpegEncoder, KeepsBrightnessOfYuyv) {
  expect_kept(RawLayout::kYuyv, 2 * kWidth + 32);
}
TEST(JpegEncoder, KeepsBrightnessOfNv12) {
  expect_kept(RawLayout::kNv12, kWidth + 16);
}
TEST(JpegEncoder, KeepsBrightnessOfGrey) {
  expect_kept(RawLayout::kGrey, kWidth);
}

TEST(JpegEncoder, DeclinesAPictureThatIsCutShort) {
  auto encoder = JpegEncoder::create(RawLayout::kGrey, kWidth, kHeight, kWidth);
  ASSERT_TRUE(encoder);
  std::vector<std::byte> raw = raw_picture(RawLayout::kGrey, 0, kWidth);
  raw.pop_back();
  EXPECT_TRUE(encoder->encode(raw).empty());
}

}  // namespace
}  // namespace marey::recordings
