// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/takes/frame_stamps.h"

#include <array>
#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

const std::array<std::string, 2> kVideos{"cam_0", "cam_1"};

Result<std::vector<std::vector<Timestamp>>> read(const std::string& text) {
  const ScratchFolder folder;
  EXPECT_TRUE(write_file(folder / "timestamps.csv", text));
  return read_frame_stamps(folder / "timestamps.csv", kVideos);
}

std::string error_of(const std::string& text) {
  const auto stamps = read(text);
  EXPECT_FALSE(stamps);
  return stamps ? std::string() : stamps.error().message();
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(FrameStamps, AreReadAsCaliscopeWritesThem) {
  const auto stamps = read(
      "sync_index,cam_id,frame_time\r\n416,1,48033.25\r\n416,0,48033.0\r\n416,7,1.0\r\n"
      "417,0,48033.5\r\n");
  ASSERT_TRUE(stamps) << stamps.error().message();
  EXPECT_EQ(stamps->at(0), (std::vector{from_seconds(0.0), from_seconds(0.5)}));
  EXPECT_EQ(stamps->at(1), std::vector{from_seconds(0.25)});
}

TEST(FrameStamps, TakeCamerasByTheirVideosNames) {
  const auto stamps = read("camera,frame_time\ncam_1,2\ncam_0,1\n");
  ASSERT_TRUE(stamps) << stamps.error().message();
  EXPECT_EQ(stamps->at(1), std::vector{from_seconds(1.0)});
}

TEST(FrameStamps, AreDeclinedAtTheirLine) {
  EXPECT_TRUE(has(error_of(""), "timestamps.csv:1: its first line names no column"));
  EXPECT_TRUE(has(error_of("cam_id,time\n0,1\n"), ":1: ")) << "no frame_time";
  EXPECT_TRUE(has(error_of("cam_id,frame_time\n0,1\n0\n"),
                  "timestamps.csv:3: expected 2 fields, found 1"));
  EXPECT_TRUE(has(error_of("cam_id,frame_time\n0,1\n1,soon\n"),
                  "timestamps.csv:3: \"soon\" is not a time in seconds"));
  EXPECT_TRUE(
      has(error_of("cam_id,frame_time\n0,1e300\n"), ":2: \"1e300\" is not a time"));
  EXPECT_TRUE(has(error_of("cam_id,frame_time\n0,2\n1,1\n0,1\n"),
                  "timestamps.csv:4: this frame of camera \"0\" is earlier"));
  EXPECT_TRUE(has(error_of("cam_id,frame_time\n0,2\n"), "no times of video \"cam_1\""));
}

}  // namespace
}  // namespace marey::recordings
