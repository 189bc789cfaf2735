// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// A part of a C3D, and other events, written with the source's other content.
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/markers/marker_file.h"
#include "tests/recordings/markers/c3d_example.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

/// Returns frames `first` to `last` of markers.
MarkerFile part_of(const MarkerFile& file, std::size_t first, std::size_t last) {
  MarkerFile out = file;
  const auto stride = static_cast<std::ptrdiff_t>(file.tracks.markers());
  const auto begin = file.tracks.samples.begin();
  out.tracks.samples.assign(begin + static_cast<std::ptrdiff_t>(first) * stride,
                            begin + static_cast<std::ptrdiff_t>(last + 1) * stride);
  return out;
}

TEST(C3dPart, HasTheWordsOfItsFramesInEachNumberFormat) {
  for (const C3dProcessor processor :
       {C3dProcessor::kIntel, C3dProcessor::kDec, C3dProcessor::kMips}) {
    for (const C3dNumbers numbers : {C3dNumbers::kReal, C3dNumbers::kInteger}) {
      const testing::ScratchFolder folder;
      const C3dInfo info = example_info(processor, numbers);
      const auto frames = example_frames(info);
      write_frames(folder / "a.c3d", info, frames);
      const auto read = read_markers(folder / "a.c3d");
      ASSERT_TRUE(read) << read.error().message();
      MarkerWriteOptions options;
      options.source = folder / "a.c3d";
      options.source_first = 1;
      const Status ok = write_markers(folder / "b.c3d", part_of(*read, 1, 3), options);
      ASSERT_TRUE(ok) << ok.error().message();
      auto reader = C3dReader::open(folder / "b.c3d");
      ASSERT_TRUE(reader) << reader.error().message();
      EXPECT_EQ(reader->info().first_frame, 8);
      EXPECT_EQ(reader->info().frames, 3);
      ASSERT_NE(find_parameter(reader->info().groups, "LAB", "MATRIX"), nullptr);
      EXPECT_EQ(reader->info().header_events.size(), 2U);
      const auto written = frames_of(*reader);
      ASSERT_EQ(written.size(), 3U);
      for (std::size_t f = 0; f < 3; ++f) {
        EXPECT_EQ(written[f].analog, frames[f + 1].analog);
        EXPECT_EQ(written[f].points, frames[f + 1].points);
      }
    }
  }
}

TEST(C3dPart, RefusesFramesThatTheSourceDoesNotHave) {
  const testing::ScratchFolder folder;
  const C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kReal);
  write_frames(folder / "a.c3d", info, example_frames(info));
  const auto read = read_markers(folder / "a.c3d");
  ASSERT_TRUE(read);
  MarkerWriteOptions options;
  options.source = folder / "a.c3d";
  options.source_first = 3;
  EXPECT_FALSE(write_markers(folder / "b.c3d", part_of(*read, 1, 3), options));
  options.source_first = 9;
  EXPECT_FALSE(write_markers(folder / "b.c3d", part_of(*read, 1, 3), options));
  options.source_first.reset();
  EXPECT_FALSE(write_markers(folder / "b.c3d", part_of(*read, 1, 3), options));
}

TEST(C3dPart, StatesAxesThatWereEstimated) {
  const testing::ScratchFolder folder;
  C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kReal);
  put_texts(info.groups, "POINT", "X_SCREEN", {""});
  put_texts(info.groups, "POINT", "Y_SCREEN", {""});
  write_frames(folder / "a.c3d", info, example_frames(info));
  auto read = read_markers(folder / "a.c3d");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_NE(read->axes.up_from, Evidence::kFile);
  MarkerWriteOptions options;
  options.source = folder / "a.c3d";
  ASSERT_TRUE(write_markers(folder / "b.c3d", *read, options));
  EXPECT_NE(read_markers(folder / "b.c3d")->axes.up_from, Evidence::kFile);
  options.state_axes = true;
  ASSERT_TRUE(write_markers(folder / "b.c3d", *read, options));
  const auto again = read_markers(folder / "b.c3d");
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_EQ(again->axes.up_from, Evidence::kFile);
  EXPECT_EQ(again->axes.up, read->axes.up);
  EXPECT_EQ(again->tracks.at(2, 0)->p_in_world, read->tracks.at(2, 0)->p_in_world);
}

TEST(C3dPart, ReplacesEventsThatChanged) {
  const testing::ScratchFolder folder;
  C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kReal);
  put_texts(info.groups, "EVENT", "DESCRIPTIONS", {"one for each event"});
  write_frames(folder / "a.c3d", info, example_frames(info));
  auto read = read_markers(folder / "a.c3d");
  ASSERT_TRUE(read);
  MarkerWriteOptions options;
  options.source = folder / "a.c3d";
  read->events = {{"Foot Strike", "Left", "Ann", 0.0625}};
  ASSERT_TRUE(write_markers(folder / "b.c3d", *read, options));
  const auto again = read_markers(folder / "b.c3d");
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_EQ(again->events, read->events);
  const auto reader = C3dReader::open(folder / "b.c3d");
  ASSERT_TRUE(reader);
  EXPECT_EQ(find_parameter(reader->info().groups, "EVENT", "DESCRIPTIONS"), nullptr);
  read->events.clear();
  ASSERT_TRUE(write_markers(folder / "c.c3d", *read, options));
  const auto none = read_markers(folder / "c.c3d");
  ASSERT_TRUE(none) << none.error().message();
  EXPECT_TRUE(none->events.empty());
}

}  // namespace
}  // namespace marey::recordings
