// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Damaged C3D files: corrections with their notes, and errors with their byte.
#include <algorithm>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/markers/c3d.h"
#include "recordings/markers/c3d_markers.h"
#include "recordings/markers/c3d_words.h"
#include "recordings/markers/marker_file.h"
#include "tests/recordings/markers/c3d_example.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

/// Returns the bytes of the example, for tests to modify.
std::string example_bytes(const C3dInfo& info) {
  const ScratchFolder folder;
  write_frames(folder / "a.c3d", info, example_frames(info));
  return *read_file(folder / "a.c3d");
}

std::string example_bytes() {
  return example_bytes(example_info(C3dProcessor::kIntel, C3dNumbers::kReal));
}

void set_word(std::string& bytes, std::size_t at, int value) {
  std::string word;
  append_c3d_word(word, C3dProcessor::kIntel, static_cast<std::uint16_t>(value));
  bytes.replace(at, 2, word);
}

std::string refusal(std::string bytes) {
  const auto reader = C3dReader::of_bytes(std::move(bytes), "walk.c3d");
  return reader ? "no refusal" : reader.error().message();
}

/// Returns all notes of reading.
std::string notes_of(std::string bytes) {
  const auto reader = C3dReader::of_bytes(std::move(bytes), "walk.c3d");
  EXPECT_TRUE(reader) << reader.error().message();
  std::string all;
  if (!reader) return all;
  for (const std::string& note : reader->info().notes) all += note + "\n";
  return all;
}

TEST(C3dBroken, RejectsOtherFormatsWithTheByte) {
  std::string bytes = example_bytes();
  bytes[1] = 'x';
  EXPECT_EQ(
      refusal(bytes),
      "walk.c3d: byte 1: this is not a C3D file: it lacks the mark 80. Next: give a file "
      "in C3D format; the extension .c3d alone is not enough.");
  EXPECT_EQ(refusal("\1\x50"),
            "walk.c3d: byte 2: the file ends before its header and parameters do. Next: "
            "copy or export it again.");
  EXPECT_EQ(refusal(""), "walk.c3d: the file is empty. Next: copy or export it again.");
  EXPECT_EQ(refusal("PathFileType\t4\n"),
            "walk.c3d: this is a TRC file of markers, not a C3D file of markers. Next: "
            "give another file, or correct the extension of this one.");
}

TEST(C3dBroken, AFileWithoutParametersIsRefused) {
  std::string bytes = example_bytes();
  for (std::size_t block = 1; block * 512 + 3 < bytes.size(); ++block) {
    bytes[block * 512 + 3] = 0;
  }
  EXPECT_EQ(
      refusal(bytes),
      "walk.c3d: byte 0: there is no parameter section in block 2 or near it. Next: "
      "export the file again.");
}

TEST(C3dBroken, ParametersInAnotherBlockAreFound) {
  std::string bytes = example_bytes();
  bytes[0] = 9;
  EXPECT_EQ(notes_of(bytes),
            "byte 0: the parameters are not in block 9 but in block 2\n");
}

TEST(C3dBroken, AFileWithoutARateIsRefused) {
  C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kReal);
  std::string bytes = example_bytes(info);
  const std::string rate = bytes.substr(20, 4);
  for (std::size_t at = 0; (at = bytes.find(rate, at)) != std::string::npos;) {
    bytes.replace(at, 4, std::string(4, '\0'));
  }
  EXPECT_EQ(
      refusal(bytes),
      "walk.c3d: byte 20: neither the header nor POINT:RATE has a frame rate between "
      "0.1 and 20000 Hz. Next: export the file again with its rate.");
}

TEST(C3dBroken, ReadsTheWholeFramesOfATruncatedFile) {
  const C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kReal);
  std::string bytes = example_bytes(info);
  const std::size_t frame_bytes = 4 * (4 * 3 + 8);
  bytes.resize(bytes.size() - frame_bytes - 3);
  const std::size_t end = bytes.size() - (frame_bytes - 3);
  EXPECT_EQ(notes_of(bytes),
            "the file ends early: of 5 frames 3 are whole, up to byte " +
                std::to_string(end) + "\n");
  auto reader = C3dReader::of_bytes(bytes, "walk.c3d");
  ASSERT_TRUE(reader);
  const std::vector<C3dFrame> frames = frames_of(*reader);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[2].points, example_frames(info)[2].points);
}

TEST(C3dBroken, AFileThatEndsBeforeItsFirstFrameDoesIsRefused) {
  const C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kReal);
  const std::size_t head = c3d_head(info)->size();
  const std::string at = std::to_string(head);
  EXPECT_EQ(refusal(example_bytes(info).substr(0, head + 50)),
            "walk.c3d: byte " + std::to_string(head + 50) +
                ": the file ends before its first frame, at byte " + at +
                ", does. Next: copy or export it again.");
}

// The header's count of analog samples is that of one channel, as in MotionMonitor's
// files.
TEST(C3dBroken, PrefersCountsThatMatchTheFileSize) {
  // 40 frames, so that no other interpretation ends in the last block.
  C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kReal);
  info.frames = 40;
  std::string bytes = example_bytes(info);
  set_word(bytes, 4, 2);
  EXPECT_EQ(notes_of(bytes),
            "the header states 2 analog samples in a frame; by the size of the file it "
            "is 8\n");
  auto reader = C3dReader::of_bytes(bytes, "walk.c3d");
  ASSERT_TRUE(reader);
  EXPECT_EQ(frames_of(*reader)[39].analog, example_frames(info)[39].analog);
}

TEST(C3dBroken, ParametersThatReachIntoTheDataAreLeftOut) {
  C3dInfo info = example_info(C3dProcessor::kIntel, C3dNumbers::kReal);
  put_texts(
      info.groups, "LAB", "LONG", std::vector<std::string>(10, std::string(99, 'x')));
  std::string bytes = example_bytes(info);
  // The header's first block of the frames: the block after the first one.
  set_word(bytes, 16, 3);
  const std::string notes = notes_of(bytes);
  EXPECT_NE(notes.find("the parameters end here"), std::string::npos) << notes;
}

TEST(C3dBroken, AFileThatEndsAnywhereIsReadOrRefused) {
  for (const C3dProcessor processor :
       {C3dProcessor::kIntel, C3dProcessor::kDec, C3dProcessor::kMips}) {
    const std::string whole =
        example_bytes(example_info(processor, C3dNumbers::kInteger));
    std::size_t read = 0;
    for (std::size_t size = 0; size <= whole.size(); ++size) {
      auto reader = C3dReader::of_bytes(whole.substr(0, size), "walk.c3d");
      if (!reader) {
        const char* part = size == 0 ? "the file is empty" : "byte";
        EXPECT_NE(reader.error().message().find(part), std::string::npos) << size;
        continue;
      }
      ++read;
      EXPECT_EQ(frames_of(*reader).size(),
                static_cast<std::size_t>(reader->info().frames));
    }
    EXPECT_GT(read, 100U);
  }
}

// Fixed seed 1: with any changed byte, reading ends without a crash.
TEST(C3dBroken, BytesThatChangedAreReadOrRefused) {
  const std::string whole =
      example_bytes(example_info(C3dProcessor::kMips, C3dNumbers::kReal));
  std::mt19937 random(1);
  for (int i = 0; i < 20'000; ++i) {
    std::string bytes = whole;
    for (unsigned n = 0; n < 1 + random() % 4; ++n) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    static_cast<void>(parse_c3d_markers(std::move(bytes), "walk.c3d"));
  }
}

}  // namespace
}  // namespace marey::recordings
