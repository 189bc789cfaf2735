// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/feeds/decode_frame.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/program/paths.h"

namespace marey::capture {
namespace {

using Bytes = std::vector<std::byte>;
using namespace std::string_view_literals;

std::string picture(int number) {
  const std::string path = marey::testing::source_dir().string() +
                           "/tests/capture/data/mjpg_" + std::to_string(number) + ".jpg";
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

DeviceSettings settings(PixelFormat format, int width_px, int height_px, int stride = 0) {
  DeviceSettings settings;
  settings.format = format;
  settings.width_px = width_px;
  settings.height_px = height_px;
  settings.stride = stride;
  return settings;
}

RawFrame frame_of(std::string_view bytes) {
  RawFrame frame;
  frame.bytes = std::as_bytes(std::span(bytes));
  frame.sequence = 7;
  return frame;
}

std::vector<int> pixels(const GrayFrame& frame) {
  std::vector<int> all;
  for (int y = 0; y < frame.height_px; ++y) {
    for (int x = 0; x < frame.width_px; ++x) {
      all.push_back(frame.pixels[y * frame.stride + x]);
    }
  }
  return all;
}

class DecodeMjpg : public ::testing::Test {
 protected:
  FrameDecoder decoder_{"cam1"};
  DeviceSettings settings_ = settings(PixelFormat::kMjpg, 320, 180);
  std::string jpeg_ = picture(1);

  std::optional<std::vector<int>> decode(std::string_view bytes) {
    const auto frame = decoder_.decode(frame_of(bytes), settings_);
    if (!frame) return std::nullopt;
    return pixels(*frame);
  }
};

TEST_F(DecodeMjpg, IsThePictureThatOpenCvSees) {
  const auto seen = decode(jpeg_);
  ASSERT_TRUE(seen);
  const cv::Mat truth =
      cv::imdecode(std::vector<char>(jpeg_.begin(), jpeg_.end()), cv::IMREAD_GRAYSCALE);
  const std::vector<int> expected(truth.begin<uchar>(), truth.end<uchar>());
  EXPECT_EQ(*seen, expected);
}

TEST_F(DecodeMjpg, DoesWithoutHuffmanTables) {
  const auto seen = decode(jpeg_);
  std::string bare = jpeg_;
  for (auto at = bare.find("\xFF\xC4"sv); at < bare.find("\xFF\xDA"sv);
       at = bare.find("\xFF\xC4"sv, at)) {
    const auto high = static_cast<unsigned char>(bare[at + 2]);
    const auto low = static_cast<unsigned char>(bare[at + 3]);
    bare.erase(at, 2U + 256U * high + low);
  }
  ASSERT_LT(bare.size(), jpeg_.size() - 100);
  EXPECT_EQ(decode(bare), seen);
}

TEST_F(DecodeMjpg, DeclinesEveryPictureThatIsCutShort) {
  for (std::size_t size = 0; size + 2 < jpeg_.size(); size += 61) {
    const auto frame = decoder_.decode(frame_of(jpeg_.substr(0, size)), settings_);
    ASSERT_FALSE(frame) << size << " of " << jpeg_.size() << " bytes";
    EXPECT_EQ(frame.error().code, Errc::kDevice);
    EXPECT_EQ(frame.error().where, "cam1: frame 7");
  }
}

TEST_F(DecodeMjpg, GoesOnAfterADamagedPicture) {
  const auto before = decode(jpeg_);
  for (const std::string_view damaged :
       {std::string_view(jpeg_).substr(0, jpeg_.size() / 2), "no jpeg"sv, ""sv}) {
    EXPECT_FALSE(decode(damaged));
    EXPECT_EQ(decode(jpeg_), before);
  }
  EXPECT_TRUE(decode(picture(2)));
}

TEST_F(DecodeMjpg, SurvivesAnyBytes) {
  std::mt19937 random(5);
  int declined = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string spoiled = jpeg_;
    for (int j = 0; j < 4; ++j) {
      spoiled[random() % spoiled.size()] = static_cast<char>(random() & 0xFFU);
    }
    declined += decode(spoiled) ? 0 : 1;
  }
  EXPECT_GT(declined, 500);
  EXPECT_TRUE(decode(jpeg_));
}

TEST_F(DecodeMjpg, ForgivesBytesTooMany) {
  const auto seen = decode(jpeg_);
  std::string before_end = jpeg_;
  before_end.insert(before_end.size() - 2, "\x12\x34"sv);
  EXPECT_EQ(decode(before_end), seen);
  EXPECT_EQ(decode(jpeg_ + std::string(1000, '\0')), seen);
}

TEST_F(DecodeMjpg, ReportsBothSizesOnAMismatch) {
  const auto frame =
      decoder_.decode(frame_of(jpeg_), settings(PixelFormat::kMjpg, 640, 360));
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().cause, "it is 320x180 and not 640x360");
}

TEST_F(DecodeMjpg, UsesTheSameMemoryAgain) {
  const auto first = decoder_.decode(frame_of(jpeg_), settings_);
  const auto second = decoder_.decode(frame_of(jpeg_), settings_, 1);
  EXPECT_EQ(first->pixels, second->pixels);
  EXPECT_EQ(second->index, 1);
}

TEST(DecodePlain, TakesTheBrightnessOfEachFormat) {
  FrameDecoder decoder("cam1");
  const std::vector<int> expected{1, 2, 3, 4};
  const auto gray = [&](PixelFormat format, std::string_view bytes, int stride) {
    const auto frame = decoder.decode(frame_of(bytes), settings(format, 2, 2, stride));
    return frame ? pixels(*frame) : std::vector<int>{};
  };
  EXPECT_EQ(gray(PixelFormat::kYuyv, "\1u\2v\3u\4v"sv, 4), expected);
  EXPECT_EQ(gray(PixelFormat::kYuyv, "\1u\2v..\3u\4v"sv, 6), expected);
  EXPECT_EQ(gray(PixelFormat::kNv12, "\1\2\3\4uv"sv, 2), expected);
  EXPECT_EQ(gray(PixelFormat::kNv12, "\1\2..\3\4..uv.."sv, 4), expected);
  EXPECT_EQ(gray(PixelFormat::kGrey, "\1\2.\3\4."sv, 3), expected);
  EXPECT_EQ(gray(PixelFormat::kGrey, "\1\2\3\4"sv, 0), expected) << "stride unknown";
}

TEST(DecodePlain, DeclinesShortOrDamagedImages) {
  FrameDecoder decoder("cam1");
  const DeviceSettings gray = settings(PixelFormat::kGrey, 2, 2, 2);
  const auto shorter = decoder.decode(frame_of("\1\2\3"), gray);
  ASSERT_FALSE(shorter);
  EXPECT_EQ(shorter.error().cause, "it has 3 of 4 bytes");
  RawFrame frame = frame_of("\1\2\3\4");
  frame.damaged = true;
  const auto damaged = decoder.decode(frame, gray);
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().cause, "the driver reports that it is damaged");
  EXPECT_TRUE(decoder.decode(frame_of("\1\2\3\4"), gray));
}

}  // namespace
}  // namespace marey::capture
