// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/library_index.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/library/clip_record_file.h"
#include "tests/support/files/run_sql.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

/// `count` clips of two sources; each second one warns, each third one is a jump.
std::vector<ClipRecord> some_records(int count) {
  std::vector<ClipRecord> out;
  for (int i = 0; i < count; ++i) {
    ClipRecord record;
    record.provenance.source_id = i % 5 == 0 ? "first" : "second";
    record.provenance.licence = i % 5 == 0 ? "CC0-1.0" : "unknown";
    record.clip_id = clip_id_of(record.provenance.source_id, "", i, i + 30);
    record.object_key = std::string(64, 'a');
    record.name = "clip " + std::to_string(i);
    record.first_frame = i;
    record.last_frame = i + 30;
    record.rate_hz = 30.0;
    record.quality = i % 2 == 0 ? Verdict::kPass : Verdict::kWarn;
    record.figures = {{"slide_cm_s", 0.1 * i, record.quality, "", FrameRange{0, 3}},
                      {"sparc", -1.0, std::nullopt, "", std::nullopt}};
    record.problems = {{{0, 3}, "slide", "leftFoot", 1.0}};
    record.labels = {{0.0, 1.0, i % 3 == 0 ? "jump" : "walk", "marey", 1.0}};
    record.events = {{2, "left.strike"}};
    out.push_back(record);
  }
  return out;
}

TEST(LibraryIndex, FindsClipsByConditions) {
  const ScratchFolder folder;
  const auto file = folder / "library.sqlite";
  ASSERT_TRUE(write_library_index(file, some_records(30)));
  const auto find = [&](const std::string& sql, std::vector<std::string> values = {}) {
    const auto found = find_in_index(file, {sql, std::move(values)});
    EXPECT_TRUE(found) << found.error().message();
    return found ? *found : std::vector<int>();
  };
  EXPECT_EQ(find("").size(), 30u);
  EXPECT_EQ(find("quality = ?", {"warn"}).size(), 15u);
  EXPECT_EQ(find("EXISTS (SELECT 1 FROM label WHERE clip = number AND label.name = ?)",
                 {"jump"}),
            (std::vector<int>{0, 3, 6, 9, 12, 15, 18, 21, 24, 27}));
  EXPECT_EQ(find("EXISTS (SELECT 1 FROM figure WHERE clip = number AND figure.name = ? "
                 "AND value > ?)",
                 {"slide_cm_s", "2.75"}),
            (std::vector<int>{28, 29}));
  EXPECT_EQ(
      find("number IN (SELECT rowid FROM words WHERE words MATCH ?)", {"jump"}).size(),
      10u);
  EXPECT_EQ(find("licence = ?", {"CC0-1.0"}).size(), 6u);
}

TEST(LibraryIndex, HasTheSameBytesForTheSameRecords) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_library_index(folder / "a.sqlite", some_records(200)));
  ASSERT_TRUE(write_library_index(folder / "b.sqlite", some_records(200)));
  EXPECT_EQ(*read_file(folder / "a.sqlite"), *read_file(folder / "b.sqlite"));
  ASSERT_TRUE(write_library_index(folder / "a.sqlite", some_records(3)))
      << "an index is replaced";
  EXPECT_EQ(find_in_index(folder / "a.sqlite", {})->size(), 3u);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.sqlite.partial"));
}

TEST(LibraryIndex, RefusesOtherFilesAndConditions) {
  const ScratchFolder folder;
  const auto refusal = [](const std::filesystem::path& file, const std::string& sql) {
    const auto found = find_in_index(file, {sql, {}});
    return found ? std::string() : found.error().message();
  };
  EXPECT_NE(refusal(folder / "none.sqlite", ""), "");
  ASSERT_TRUE(write_file(folder / "text.sqlite", "this is text"));
  EXPECT_NE(refusal(folder / "text.sqlite", "").find("library build"), std::string::npos);
  const auto file = folder / "library.sqlite";
  ASSERT_TRUE(write_library_index(file, some_records(2)));
  EXPECT_NE(refusal(file, "nonsense = 1"), "");
  EXPECT_FALSE(write_library_index(folder / "no folder" / "library.sqlite", {}));
}

}  // namespace
}  // namespace marey::recordings
