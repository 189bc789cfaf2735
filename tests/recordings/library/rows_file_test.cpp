// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/rows_file.h"

#include <cstring>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

constexpr std::size_t kColumns = 3;

/// Clips of 0 to 4 rows; the value encodes the clip and the place.
std::vector<std::vector<float>> some_clips(int count) {
  std::vector<std::vector<float>> out;
  for (int clip = 0; clip < count; ++clip) {
    auto& rows = out.emplace_back(kColumns * static_cast<std::size_t>(clip % 5));
    for (std::size_t k = 0; k < rows.size(); ++k) {
      rows[k] = static_cast<float>(clip) + 0.01F * static_cast<float>(k);
    }
  }
  return out;
}

void write_clips(const fs::path& path, const std::vector<std::vector<float>>& clips) {
  auto file = RowsFileWriter::create(path, kColumns);
  ASSERT_TRUE(file) << file.error().message();
  for (const auto& rows : clips) file->add_clip(rows);
  const Status ok = file->commit();
  ASSERT_TRUE(ok) << ok.error().message();
}

void expect_clips(const RowsFile& file, const std::vector<std::vector<float>>& clips) {
  const RowsView view = file.rows();
  EXPECT_EQ(view.columns, kColumns);
  ASSERT_EQ(view.begins.size(), clips.size() + 1);
  for (std::size_t clip = 0; clip < clips.size(); ++clip) {
    const auto rows =
        view.values.subspan(view.begins[clip] * kColumns,
                            (view.begins[clip + 1] - view.begins[clip]) * kColumns);
    EXPECT_EQ(std::vector<float>(rows.begin(), rows.end()), clips[clip]) << clip;
  }
  const Status ok = file.check_values();
  EXPECT_TRUE(ok) << ok.error().message();
}

std::string refusal_of_rows(const fs::path& path, std::size_t columns = kColumns) {
  const auto file = RowsFile::open(path, columns);
  if (!file) return file.error().message();
  const Status ok = file->check_values();
  return ok ? std::string() : ok.error().message();
}

TEST(RowsFile, HasTheRowsOfAllClips) {
  const ScratchFolder folder;
  const fs::path path = folder / "search/features.f32";
  for (const int count : {0, 1, 2, 7, 100}) {
    write_clips(path, some_clips(count));
    auto file = RowsFile::open(path, kColumns);
    ASSERT_TRUE(file) << file.error().message();
    expect_clips(*file, some_clips(count));
    const RowsFile moved = *std::move(file);
    expect_clips(moved, some_clips(count));
  }
  EXPECT_EQ(fs::file_size(folder / "search/features.idx"), 101u * 8u);
  EXPECT_EQ(fs::file_size(path), 64u + 200u * kColumns * 4u);
}

TEST(RowsFile, HasTheSameBytesForTheSameRows) {
  const ScratchFolder folder;
  write_clips(folder / "a.f32", some_clips(20));
  write_clips(folder / "b.f32", some_clips(20));
  EXPECT_EQ(*read_file(folder / "a.f32"), *read_file(folder / "b.f32"));
  EXPECT_EQ(*read_file(folder / "a.idx"), *read_file(folder / "b.idx"));
}

TEST(RowsFile, NeedsNoIndexForASingleClip) {
  const ScratchFolder folder;
  const auto rows = some_clips(5).back();
  ASSERT_TRUE(write_file(folder / "clip.f32", rows_file_bytes(rows, kColumns)));
  const auto file = RowsFile::open(folder / "clip.f32", kColumns);
  ASSERT_TRUE(file) << file.error().message();
  expect_clips(*file, {rows});
  write_clips(folder / "one.f32", {rows});
  EXPECT_EQ(*read_file(folder / "one.f32"), rows_file_bytes(rows, kColumns));
  ASSERT_TRUE(write_file(folder / "none.f32", rows_file_bytes({}, kColumns)));
  expect_clips(*RowsFile::open(folder / "none.f32", kColumns), {{}});
}

TEST(RowsFile, LeavesNothingWithoutCommit) {
  const ScratchFolder folder;
  {
    auto file = RowsFileWriter::create(folder / "a.f32", kColumns);
    ASSERT_TRUE(file);
    file->add_clip(some_clips(3).back());
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(RowsFile, StaysReadableWhenItIsReplaced) {
  const ScratchFolder folder;
  write_clips(folder / "a.f32", some_clips(9));
  const auto file = RowsFile::open(folder / "a.f32", kColumns);
  ASSERT_TRUE(file);
  write_clips(folder / "a.f32", some_clips(4));
  expect_clips(*file, some_clips(9));
  expect_clips(*RowsFile::open(folder / "a.f32", kColumns), some_clips(4));
}

TEST(RowsFile, RefusesOtherFiles) {
  const ScratchFolder folder;
  const std::string next = "Next: remove it and build the library again";
  EXPECT_NE(refusal_of_rows(folder / "none.f32").find(next), std::string::npos);
  EXPECT_NE(refusal_of_rows(folder.path()), "");
  ASSERT_TRUE(write_file(folder / "text.f32", std::string(200, 'x')));
  EXPECT_NE(refusal_of_rows(folder / "text.f32").find("no file of rows"),
            std::string::npos);
  write_clips(folder / "a.f32", some_clips(9));
  EXPECT_EQ(refusal_of_rows(folder / "a.f32"), "");
  EXPECT_NE(refusal_of_rows(folder / "a.f32", 64).find("3 numbers instead of 64"),
            std::string::npos);
  fs::remove(folder / "a.idx");
  EXPECT_NE(refusal_of_rows(folder / "a.f32").find("a.idx"), std::string::npos);
}

TEST(RowsFile, RefusesAnIndexOfOtherRows) {
  const ScratchFolder folder;
  write_clips(folder / "a.f32", some_clips(9));
  write_clips(folder / "b.f32", some_clips(10));
  auto swapped = some_clips(9);
  std::swap(swapped[1], swapped[2]);
  write_clips(folder / "c.f32", swapped);
  for (const char* other : {"b.idx", "c.idx"}) {
    fs::copy_file(folder / other, folder / "a.idx", fs::copy_options::overwrite_existing);
    EXPECT_NE(refusal_of_rows(folder / "a.f32").find("library build"), std::string::npos)
        << other;
  }
}

TEST(RowsFile, RefusesEveryTruncationAndEveryFlippedByte) {
  const ScratchFolder folder;
  const fs::path rows = folder / "a.f32";
  const fs::path index = folder / "a.idx";
  write_clips(rows, some_clips(6));
  for (const fs::path& path : {rows, index}) {
    const std::string whole = *read_file(path);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      ASSERT_TRUE(write_file(path, whole.substr(0, size)));
      EXPECT_NE(refusal_of_rows(rows), "") << path << " " << size;
    }
    ASSERT_TRUE(write_file(path, whole + '\0'));
    EXPECT_NE(refusal_of_rows(rows), "") << path << " is too long";
    for (std::size_t at = 0; at < whole.size(); ++at) {
      for (const int mask : {1, 0x80, 0xff}) {
        std::string bytes = whole;
        bytes[at] = static_cast<char>(bytes[at] ^ mask);
        ASSERT_TRUE(write_file(path, bytes));
        EXPECT_NE(refusal_of_rows(rows), "") << path << " " << at;
      }
    }
    ASSERT_TRUE(write_file(path, whole));
  }
  EXPECT_EQ(refusal_of_rows(rows), "");
}

// A size that overflows 64 bits must not pass for a small one.
TEST(RowsFile, RefusesSizesThatOverflow) {
  const ScratchFolder folder;
  const std::string good = rows_file_bytes(some_clips(5).back(), kColumns);
  for (const std::uint64_t count : {std::uint64_t{1} << 62, ~std::uint64_t{0}}) {
    for (const std::size_t at : {16U, 24U}) {
      std::string bytes = good;
      std::memcpy(bytes.data() + at, &count, sizeof count);
      ASSERT_TRUE(write_file(folder / "a.f32", bytes));
      EXPECT_NE(refusal_of_rows(folder / "a.f32"), "");
    }
  }
}

}  // namespace
}  // namespace marey::recordings
