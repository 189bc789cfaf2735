// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/library_records.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/library/clip_record_file.h"
#include "recordings/library/library_index.h"
#include "recordings/library/select_clips.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/files/run_sql.h"
#include "tests/support/files/simulated_records.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

std::vector<std::string> record_texts(const std::vector<ClipRecord>& records) {
  std::vector<std::string> out;
  for (const ClipRecord& record : records) out.push_back(clip_record_text(record));
  return out;
}

std::string refusal_of_records(const fs::path& index) {
  const auto read = read_library_records(index);
  return read ? std::string() : read.error().message();
}

TEST(LibraryRecords, EqualTheWrittenRecords) {
  const ScratchFolder folder;
  const fs::path index = folder / "library.sqlite";
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U}) {
    testing::SimulatedRecordsOptions options;
    options.seed = seed;
    options.clips = 1 + 40 * static_cast<int>(seed);
    options.labels = 2 + static_cast<int>(seed);
    const auto records = testing::simulated_records(options);
    ASSERT_TRUE(write_library_index(index, records));
    const auto read = read_library_records(index);
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(record_texts(*read), record_texts(records)) << "seed " << seed;
    EXPECT_EQ(*count_library_clips(index), options.clips);
  }
}

TEST(LibraryRecords, KeepEveryTextAndOrder) {
  ClipRecord odd;
  odd.clip_id = "0123456789abcdef";
  odd.object_key = std::string(64, 'b');
  odd.name = std::string("a'b\"c\0d%_\n\xff", 11);
  odd.provenance.path = "walk é.bvh";
  odd.first_frame = -7;
  odd.last_frame = 2147483000;
  odd.rate_hz = 1e-300;
  odd.figures = {{"z", 1e300, std::nullopt, "", std::nullopt},
                 {"a", 0.1 + 0.2, Verdict::kFail, "hips", FrameRange{-5, 7}},
                 {"a", -0.0, Verdict::kPass, "", std::nullopt}};
  odd.labels = {{3.0, 1.0, "", "", 0.0}, {3.0, 1.0, "", "", 0.0}};
  ClipRecord copy = odd;
  copy.clip_id = "fedcba9876543210_mirror";
  copy.mirror_of = odd.clip_id;
  copy.provenance.path = "a copy of the same bytes.bvh";
  const ScratchFolder folder;
  ASSERT_TRUE(write_library_index(folder / "library.sqlite", std::vector{odd, copy}));
  const auto read = read_library_records(folder / "library.sqlite");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->size(), 2u);
  EXPECT_EQ((*read)[0].name, odd.name);
  EXPECT_EQ((*read)[0].first_frame, odd.first_frame);
  EXPECT_EQ((*read)[0].figures.size(), 3u);
  EXPECT_EQ((*read)[0].figures[1].value, 0.1 + 0.2);
  EXPECT_EQ((*read)[0].figures[1].frames->first, -5);
  EXPECT_EQ((*read)[0].labels.size(), 2u);
  EXPECT_EQ((*read)[1].provenance.path, copy.provenance.path);
}

TEST(LibraryRecords, AreNoneInAnEmptyLibrary) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_library_index(folder / "library.sqlite", {}));
  EXPECT_TRUE(read_library_records(folder / "library.sqlite")->empty());
  EXPECT_TRUE(read_clip_summaries(folder / "library.sqlite", 0, 10)->empty());
  EXPECT_EQ(*count_library_clips(folder / "library.sqlite"), 0);
}

TEST(LibraryRecords, AreReadByNumberInTheOrderAsked) {
  const ScratchFolder folder;
  const fs::path index = folder / "library.sqlite";
  const auto records = testing::simulated_records();
  ASSERT_TRUE(write_library_index(index, records));
  const std::vector<int> numbers = {7, 99, 0, 7};
  const auto read = read_library_records(index, numbers);
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->size(), 4u);
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const auto& expected = records[static_cast<std::size_t>(numbers[k])];
    EXPECT_EQ(clip_record_text((*read)[k]), clip_record_text(expected));
  }
  EXPECT_TRUE(read_library_records(index, std::vector<int>())->empty());
  for (const int wrong : {-1, 100}) {
    const auto refused = read_library_records(index, std::vector<int>{3, wrong});
    ASSERT_FALSE(refused);
    EXPECT_NE(
        refused.error().message().find("marey library build " + folder.path().string()),
        std::string::npos)
        << refused.error().message();
  }
}

TEST(ClipSummaries, ListPagesOfALibrary) {
  const ScratchFolder folder;
  const fs::path index = folder / "library.sqlite";
  const auto records = testing::simulated_records();
  ASSERT_TRUE(write_library_index(index, records));
  const auto page = read_clip_summaries(index, 90, 30);
  ASSERT_TRUE(page) << page.error().message();
  ASSERT_EQ(page->size(), 10u) << "the last page is shorter";
  for (std::size_t k = 0; k < page->size(); ++k) {
    const ClipSummary& row = (*page)[k];
    const ClipRecord& record = records[90 + k];
    EXPECT_EQ(row.number, static_cast<int>(90 + k));
    EXPECT_EQ(row.clip_id, record.clip_id);
    EXPECT_EQ(row.name, record.name);
    EXPECT_EQ(row.duration_s, record.duration_s());
    EXPECT_EQ(row.rate_hz, record.rate_hz);
    EXPECT_EQ(row.quality, record.quality);
    EXPECT_EQ(row.licence, record.provenance.licence);
    EXPECT_EQ(row.subject, record.provenance.subject);
    EXPECT_EQ(row.split, record.split);
    for (const ClipLabel& label : record.labels) {
      const auto& texts = label.by == "marey" ? row.found_labels : row.labels;
      EXPECT_EQ(std::count(texts.begin(), texts.end(), label.text), 1) << label.text;
      EXPECT_TRUE(std::is_sorted(texts.begin(), texts.end()));
    }
  }
  EXPECT_TRUE(read_clip_summaries(index, 100, 30)->empty());
  EXPECT_TRUE(read_clip_summaries(index, 2147483647, 2147483647)->empty());
  EXPECT_EQ(read_clip_summaries(index, std::vector<int>{5, 4})->back().number, 4);
}

TEST(LibraryRecords, RefuseOtherFiles) {
  const ScratchFolder folder;
  EXPECT_NE(refusal_of_records(folder / "none.sqlite").find("library build"),
            std::string::npos);
  EXPECT_NE(refusal_of_records(folder.path()), "");
  ASSERT_TRUE(write_file(folder / "text.sqlite", "this is text"));
  EXPECT_NE(refusal_of_records(folder / "text.sqlite").find("library build"),
            std::string::npos);
  ASSERT_TRUE(write_file(folder / "empty.sqlite", ""));
  EXPECT_NE(refusal_of_records(folder / "empty.sqlite"), "");
  const fs::path index = folder / "library.sqlite";
  ASSERT_TRUE(write_library_index(index, testing::simulated_records()));
  testing::run_sql(index, "PRAGMA user_version = 9");
  EXPECT_NE(refusal_of_records(index).find("another version"), std::string::npos);
}

TEST(LibraryRecords, RefuseTablesThatDoNotFit) {
  const ScratchFolder folder;
  const fs::path index = folder / "library.sqlite";
  for (const char* damage : {"DELETE FROM clip WHERE number = 0",
                             "DELETE FROM clip WHERE number = 50",
                             "UPDATE clip SET quality = 'good' WHERE number = 3",
                             "UPDATE clip SET rate_by = '' WHERE number = 3",
                             "UPDATE clip SET last = 1 << 40 WHERE number = 3",
                             "UPDATE clip SET first = last + 1",
                             "UPDATE clip SET first = -2147483647",
                             "UPDATE clip SET number = 1 << 40 WHERE number = 3",
                             "UPDATE clip SET number = -1 WHERE number = 3",
                             "UPDATE figure SET a = 1 << 40",
                             "UPDATE clip SET id = '../../../../etc/x' WHERE number = 3",
                             "UPDATE clip SET id = '0123456789ABCDEF' WHERE number = 3",
                             "UPDATE clip SET id = '' WHERE number = 3",
                             "UPDATE clip SET key = '../x' WHERE number = 3",
                             "UPDATE clip SET key = '' WHERE number = 3",
                             "UPDATE clip SET duplicate_of = 'x' WHERE number = 3",
                             "UPDATE clip SET mirror_of = '/' WHERE number = 3",
                             "DELETE FROM source",
                             "DROP TABLE event",
                             "DROP TABLE clip"}) {
    ASSERT_TRUE(write_library_index(index, testing::simulated_records()));
    testing::run_sql(index, damage);
    EXPECT_NE(refusal_of_records(index).find("damaged"), std::string::npos) << damage;
  }
}

TEST(ClipSummaries, RefuseIdsThatAreNone) {
  const ScratchFolder folder;
  const fs::path index = folder / "library.sqlite";
  ASSERT_TRUE(write_library_index(index, testing::simulated_records()));
  testing::run_sql(index, "UPDATE clip SET id = '../x' WHERE number = 3");
  EXPECT_TRUE(read_clip_summaries(index, 0, 3));
  EXPECT_FALSE(read_clip_summaries(index, 0, 4));
}

/// Reads everything that the readers of an index read. Any result is right.
void read_all(const fs::path& index) {
  (void)read_library_records(index);
  (void)read_clip_summaries(index, 0, 1000);
  const auto selector = ClipSelector::open(index);
  if (!selector) return;
  (void)selector->words(WordKind::kLabel);
  (void)selector->with_label("content:walk");
  (void)selector->with_figure("speed_m_s", Comparison::kLess, 1.0);
  (void)selector->with_words(std::vector<std::string>{"walk"});
  (void)selector->with_part_of_text(ClipText::kPath, "take");
}

// Proves that no damage ends the program or reads forever. Changed values are not found:
// the index has no checksum.
TEST(LibraryRecords, SurviveDamage) {
  const ScratchFolder folder;
  const fs::path index = folder / "library.sqlite";
  testing::SimulatedRecordsOptions options;
  options.clips = 30;
  ASSERT_TRUE(write_library_index(index, testing::simulated_records(options)));
  const std::string whole = *read_file(index);
  for (std::size_t size = 0; size < whole.size(); size += 4096 + 512) {
    ASSERT_TRUE(write_file(index, whole.substr(0, size)));
    read_all(index);
    EXPECT_NE(refusal_of_records(index), "") << size;
  }
  testing::Dice dice(5);
  const auto size = static_cast<double>(whole.size());
  for (int k = 0; k < 200; ++k) {
    std::string bytes = whole;
    for (int flip = 0; flip < 1 + k / 20; ++flip) {
      // Half of them in the first bytes of pages, which are the structure.
      auto at = static_cast<std::size_t>(dice.between(0.0, size));
      if (k % 2 == 0) at = at / 4096 * 4096 + at % 200;
      if (at >= bytes.size()) continue;
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << (k % 8)));
    }
    ASSERT_TRUE(write_file(index, bytes));
    read_all(index);
  }
}

}  // namespace
}  // namespace marey::recordings
