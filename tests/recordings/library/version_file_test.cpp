// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/library/version_file.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

ClipRecord versioned_clip(const std::string& id) {
  ClipRecord out;
  out.clip_id = id;
  out.object_key = std::string(64, 'a');
  out.name = "walk " + id;
  out.provenance.source_id = "source of " + id;
  out.provenance.licence = "MIT OR Apache-2.0";
  return out;
}

std::vector<VersionLine> version_lines(const std::vector<ClipRecord>& records) {
  std::vector<VersionLine> out;
  for (const ClipRecord& record : records) out.push_back(version_line(record));
  return *parse_version(version_text(std::move(out)), "version");
}

TEST(VersionFile, ReadsWhatItWrote) {
  ClipRecord odd = versioned_clip("b");
  odd.name = "a\tname\nof two lines";
  const auto lines = version_lines({odd, versioned_clip("a")});
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].clip_id, "a");
  EXPECT_EQ(lines[0].licence, "MIT OR Apache-2.0");
  EXPECT_EQ(lines[0].quality, "pass");
  EXPECT_EQ(lines[1].name, "a name of two lines");
}

TEST(VersionFile, DoesNotDependOnTheOrderOfClips) {
  const VersionLine a = version_line(versioned_clip("a"));
  const VersionLine b = version_line(versioned_clip("b"));
  EXPECT_EQ(version_text({a, b}), version_text({b, a}));
}

TEST(VersionFile, RefusesADamagedLine) {
  const std::string text = version_text({version_line(versioned_clip("a"))});
  for (std::size_t size = 0; size < text.size(); ++size) {
    const auto read = parse_version(text.substr(0, size), "0001.txt");
    // Cut after the first line, it is a version without clips.
    if (read) {
      EXPECT_TRUE(read->empty()) << size;
    } else {
      EXPECT_NE(read.error().where.find("0001.txt"), std::string::npos);
    }
  }
}

TEST(VersionFile, NamesTheChangesOfEachClip) {
  const auto before = version_lines({versioned_clip("a"),
                                     versioned_clip("b"),
                                     versioned_clip("c"),
                                     versioned_clip("d")});
  ClipRecord quality = versioned_clip("a");
  quality.quality = Verdict::kFail;
  ClipRecord labels = versioned_clip("b");
  labels.labels.push_back({0.0, 1.0, "turn", "anna", 1.0});
  ClipRecord motion = versioned_clip("c");
  motion.object_key = std::string(64, 'b');
  ClipRecord source = versioned_clip("e");
  source.name = "walk d";
  const auto after =
      version_lines({quality, labels, motion, source, versioned_clip("f")});
  const auto changes = compare_versions(before, after);
  ASSERT_EQ(changes.size(), 5U);
  EXPECT_EQ(changes[0].quality_before, "pass");
  EXPECT_EQ(changes[0].quality_after, "fail");
  EXPECT_FALSE(changes[0].has_new_labels);
  EXPECT_TRUE(changes[1].has_new_labels);
  EXPECT_FALSE(changes[1].has_new_state);
  EXPECT_TRUE(changes[2].has_new_motion);
  EXPECT_TRUE(changes[3].has_new_source);
  EXPECT_EQ(changes[3].clip_id, "e");
  EXPECT_TRUE(changes[4].quality_before.empty());
  EXPECT_TRUE(compare_versions(after, after).empty());
  EXPECT_EQ(compare_versions(after, before).size(), 5U);
}

TEST(VersionFile, ListsVersionsByNumber) {
  const testing::ScratchFolder folder;
  for (const int number : {10, 2, 12345}) {
    ASSERT_TRUE(write_file(version_path(folder.path(), number), ""));
  }
  ASSERT_TRUE(write_file(folder.path() / "versions" / "notes.txt", ""));
  ASSERT_TRUE(write_file(folder.path() / "versions" / "7.txt", ""));
  const auto versions = list_versions(folder.path());
  ASSERT_EQ(versions.size(), 3U);
  EXPECT_EQ(versions[0].number, 2);
  EXPECT_EQ(versions[2].number, 12345);
}

}  // namespace
}  // namespace marey::recordings
