// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/c3d.h"

#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/markers/c3d_words.h"
#include "tests/recordings/markers/c3d_example.h"
#include "tests/support/program/count_allocations.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

constexpr std::array kProcessors{
    C3dProcessor::kIntel, C3dProcessor::kDec, C3dProcessor::kMips};

using Kind = std::tuple<C3dProcessor, C3dNumbers>;

class C3dKinds : public ::testing::TestWithParam<Kind> {};

void expect_same_groups(const std::vector<C3dGroup>& read,
                        const std::vector<C3dGroup>& said) {
  for (const C3dGroup& group : said) {
    for (const C3dParameter& wanted : group.parameters) {
      const C3dParameter* found = find_parameter(read, group.name, wanted.name);
      ASSERT_NE(found, nullptr) << wanted.name;
      EXPECT_EQ(found->description, wanted.description);
      EXPECT_EQ(found->locked, wanted.locked);
      EXPECT_EQ(found->dimensions, wanted.dimensions);
      EXPECT_EQ(found->values.index(), wanted.values.index());
      EXPECT_EQ(texts(*found), texts(wanted));
      EXPECT_EQ(numbers(*found), numbers(wanted));
    }
  }
}

TEST_P(C3dKinds, AreReadAsTheyWereWrittenToTheLastBit) {
  const ScratchFolder folder;
  const C3dInfo info = example_info(std::get<0>(GetParam()), std::get<1>(GetParam()));
  const std::vector<C3dFrame> frames = example_frames(info);
  write_frames(folder / "a.c3d", info, frames);
  Result<C3dReader> reader = C3dReader::open(folder / "a.c3d");
  ASSERT_TRUE(reader) << reader.error().message();
  const C3dInfo& read = reader->info();
  EXPECT_TRUE(read.notes.empty()) << read.notes[0];
  EXPECT_EQ(read.processor, info.processor);
  EXPECT_EQ(read.numbers, info.numbers);
  EXPECT_EQ(read.points, 3);
  EXPECT_EQ(read.analog_channels, 2);
  EXPECT_EQ(read.analog_per_frame, 4);
  EXPECT_EQ(read.rate_hz, 120.0);
  EXPECT_EQ(read.scale, 0.125);
  EXPECT_EQ(read.first_frame, 7);
  EXPECT_EQ(read.frames, 5);
  EXPECT_EQ(read.interpolation_gap, 10);
  expect_same_groups(read.groups, info.groups);
  ASSERT_EQ(read.header_events.size(), 2U);
  EXPECT_EQ(read.header_events[1].label, "RTO");
  EXPECT_EQ(read.header_events[1].time_s, 0.5);
  EXPECT_FALSE(read.header_events[1].shown);
  const std::vector<C3dFrame> again = frames_of(*reader);
  ASSERT_EQ(again.size(), frames.size());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    EXPECT_EQ(again[f].points, frames[f].points) << f;
    EXPECT_EQ(again[f].analog, frames[f].analog) << f;
  }
}

TEST_P(C3dKinds, WrittenAgainAreTheSameBytes) {
  const ScratchFolder folder;
  const C3dInfo info = example_info(std::get<0>(GetParam()), std::get<1>(GetParam()));
  write_frames(folder / "a.c3d", info, example_frames(info));
  Result<C3dReader> reader = C3dReader::open(folder / "a.c3d");
  ASSERT_TRUE(reader);
  write_frames(folder / "b.c3d", reader->info(), frames_of(*reader));
  EXPECT_EQ(*read_file(folder / "a.c3d"), *read_file(folder / "b.c3d"));
}

std::string kind_name(const ::testing::TestParamInfo<Kind>& kind) {
  const std::array names{"Intel", "Dec", "Mips"};
  const auto processor = static_cast<std::size_t>(std::get<0>(kind.param)) - 84;
  return std::string(names.at(processor)) +
         (std::get<1>(kind.param) == C3dNumbers::kReal ? "Real" : "Integer");
}

INSTANTIATE_TEST_SUITE_P(C3d,
                         C3dKinds,
                         ::testing::Combine(::testing::ValuesIn(kProcessors),
                                            ::testing::Values(C3dNumbers::kReal,
                                                              C3dNumbers::kInteger)),
                         kind_name);

TEST(C3dWords, RealsOfEveryMachineAreReadAsWritten) {
  for (const C3dProcessor processor : kProcessors) {
    for (const float value :
         {0.0F, 1.0F, -1.0F, 0.1F, -1234.5678F, 3e-38F, 1e37F, 65535.0F, -0.083333336F}) {
      std::string bytes;
      append_c3d_real(bytes, processor, value);
      ASSERT_EQ(bytes.size(), 4U);
      EXPECT_EQ(c3d_real(processor, bytes.data()), value);
    }
  }
}

// 1.0 and -15.0 as VAX manuals print them: 0x4080 and 0xC270 in the first word.
TEST(C3dWords, VaxRealsHaveTheBitsOfTheManual) {
  std::string bytes;
  append_c3d_real(bytes, C3dProcessor::kDec, 1.0F);
  EXPECT_EQ(bytes, std::string("\x80\x40\x00\x00", 4));
  bytes.clear();
  append_c3d_real(bytes, C3dProcessor::kDec, -15.0F);
  EXPECT_EQ(bytes, std::string("\x70\xC2\x00\x00", 4));
}

TEST(C3dWords, SaturateLargeVaxRealsAndReplaceNaNByZero) {
  const auto through = [](float value) {
    std::string bytes;
    append_c3d_real(bytes, C3dProcessor::kDec, value);
    return c3d_real(C3dProcessor::kDec, bytes.data());
  };
  const float largest = through(std::numeric_limits<float>::infinity());
  EXPECT_GT(largest, 1.7e38F);
  EXPECT_TRUE(std::isfinite(largest));
  EXPECT_EQ(through(3e38F), largest);
  EXPECT_EQ(through(-3e38F), -largest);
  EXPECT_EQ(through(std::numeric_limits<float>::quiet_NaN()), 0.0F);
}

TEST(C3d, MoreThan255LabelsAreKept) {
  const ScratchFolder folder;
  C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kReal);
  std::vector<std::string> labels;
  for (int i = 0; i < 700; ++i) labels.push_back("marker" + std::to_string(i));
  info.points = 700;
  info.frames = 1;
  info.analog_channels = 0;
  info.analog_per_frame = 1;
  put_texts(info.groups, "POINT", "LABELS", labels);
  C3dFrame frame;
  frame.points.assign(4 * 700, 5.0F);
  write_frames(folder / "many.c3d", info, {frame});
  const Result<C3dReader> reader = C3dReader::open(folder / "many.c3d");
  ASSERT_TRUE(reader) << reader.error().message();
  EXPECT_EQ(reader->info().points, 700);
  EXPECT_EQ(texts_of_all(reader->info().groups, "point", "labels"), labels);
}

TEST(C3d, MoreThan65535FramesAreCounted) {
  const ScratchFolder folder;
  C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kInteger);
  info.points = 1;
  info.analog_channels = 0;
  info.analog_per_frame = 1;
  info.frames = 70'000;
  info.first_frame = 66'001;
  const C3dFrame frame{{1, 2, 3, 0}, {}};
  write_frames(folder / "long.c3d", info, std::vector<C3dFrame>(70'000, frame));
  Result<C3dReader> reader = C3dReader::open(folder / "long.c3d");
  ASSERT_TRUE(reader) << reader.error().message();
  EXPECT_EQ(reader->info().frames, 70'000);
  EXPECT_EQ(reader->info().first_frame, 66'001);
  EXPECT_TRUE(reader->info().notes.empty());
  EXPECT_EQ(frames_of(*reader).size(), 70'000U);
}

// However long the file is.
TEST(C3d, FramesAfterTheFirstTakeNoMemory) {
  const ScratchFolder folder;
  C3dInfo info = example_info(C3dProcessor::kDec, C3dNumbers::kReal);
  info.frames = 2000;
  write_frames(folder / "a.c3d", info, example_frames(info));
  Result<C3dReader> reader = C3dReader::open(folder / "a.c3d");
  ASSERT_TRUE(reader);
  C3dFrame frame;
  ASSERT_TRUE(*reader->next(frame));
  const long before = testing::allocations();
  int frames = 1;
  while (*reader->next(frame)) ++frames;
  EXPECT_EQ(testing::allocations(), before);
  EXPECT_EQ(frames, 2000);
}

TEST(C3d, UnsignedSamplesAreReadWithoutASign) {
  const ScratchFolder folder;
  C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kInteger);
  put_texts(info.groups, "ANALOG", "FORMAT", {"UNSIGNED"});
  std::vector<C3dFrame> frames = example_frames(info);
  for (C3dFrame& frame : frames) frame.analog.assign(8, 65000.0F);
  write_frames(folder / "a.c3d", info, frames);
  Result<C3dReader> reader = C3dReader::open(folder / "a.c3d");
  ASSERT_TRUE(reader);
  EXPECT_EQ(frames_of(*reader)[0].analog, frames[0].analog);
}

TEST(C3d, ParametersThatAreTooLongAreRefusedByName) {
  C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kReal);
  put_parameter(info.groups, "LAB", {std::string(200, 'N'), "", false, {}, C3dBytes{1}});
  const auto head = c3d_head(info);
  ASSERT_FALSE(head);
  EXPECT_NE(head.error().message().find("parameter LAB:NNN"), std::string::npos);
}

}  // namespace
}  // namespace marey::recordings
