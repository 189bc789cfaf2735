// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/markers/marker_map.h"

#include <string>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

/// The example of docs/formats/markers.md.
std::string example() {
  return marey::testing::formats_example("markers", "[markers]");
}

std::string mistake_of(const std::string& text) {
  const auto map = parse_marker_map(text, "map.toml");
  return map ? "none" : map.error().message();
}

TEST(MarkerMap, ReadsTheNameAndTheLineOfEachLabel) {
  const auto map = parse_marker_map(example(), "map.toml");
  ASSERT_TRUE(map) << map.error().message();
  EXPECT_EQ(map->file, "map.toml");
  ASSERT_EQ(map->entries.size(), 5U);
  EXPECT_EQ(map->entries[0].label, "LASI");
  EXPECT_EQ(map->entries[0].name, "left_asis");
  EXPECT_EQ(map->entries[0].line, 2);
  EXPECT_EQ(map->entries[1].label, "R.Knee");
  EXPECT_EQ(map->entries[2].name, "leftUpperLeg");
  EXPECT_EQ(map->entries[3].name, "");
  EXPECT_EQ(map->entries[4].label, "*12");
  EXPECT_EQ(map->entries[4].name, "");
  EXPECT_EQ(map->entries[4].line, 6);
}

TEST(MarkerMap, KeepsTheOrderOfTheFile) {
  const auto map = parse_marker_map("[markers]\nz = \"c7\"\na = \"t10\"\n", "map.toml");
  ASSERT_TRUE(map);
  EXPECT_EQ(map->entries[0].label, "z");
  EXPECT_EQ(map->entries[1].label, "a");
}

TEST(MarkerMap, IsReadFromAFile) {
  const testing::ScratchFolder scratch;
  const auto path = scratch.path() / "map.toml";
  ASSERT_TRUE(write_file(path, example()));
  const auto map = read_marker_map(path);
  ASSERT_TRUE(map) << map.error().message();
  EXPECT_EQ(map->file, path.string());
  EXPECT_EQ(map->entries.size(), 5U);
  EXPECT_FALSE(read_marker_map(scratch.path() / "none.toml"));
}

TEST(MarkerMap, RejectsLandmarksThatAreNotText) {
  EXPECT_EQ(mistake_of("[markers]\nLASI = 3\n"),
            "map.toml:2: \"LASI\" must be text in quotes. Next: write it as "
            "docs/formats/markers.md "
            "shows.");
  EXPECT_EQ(mistake_of("[markers]\nLASI = [\"left_asis\"]\n"),
            "map.toml:2: \"LASI\" must be text in quotes. Next: write it as "
            "docs/formats/markers.md "
            "shows.");
}

// In TOML that is a table R with a key ASIS.
TEST(MarkerMap, ReportsHowToQuoteALabelWithAPoint) {
  EXPECT_EQ(
      mistake_of("[markers]\nC7 = \"c7\"\nR.ASIS = \"right_asis\"\n"),
      "map.toml:3: \"R\" must be text in quotes. Next: write labels that have a point "
      "in quotes: \"R.ASIS\" = \"right_asis\".");
}

TEST(MarkerMap, RefusesUnknownKeys) {
  EXPECT_EQ(mistake_of("[marker]\nLASI = \"left_asis\"\n"),
            "map.toml:1: unknown key \"marker\". Next: perhaps you mean \"markers\".");
  EXPECT_EQ(mistake_of("set = \"CMU\"\n[markers]\nLASI = \"left_asis\"\n"),
            "map.toml:1: unknown key \"set\". Next: choose one of \"markers\".");
}

TEST(MarkerMap, RefusesAFileWithoutLabels) {
  EXPECT_EQ(mistake_of("[markers]\n"),
            "map.toml:1: no label in [markers]. Next: add a line for each marker: LASI = "
            "\"left_asis\".");
  EXPECT_EQ(mistake_of(""),
            "map.toml: the file is empty. Next: copy or export it again.");
}

TEST(MarkerMap, RefusesALabelTwice) {
  const std::string mistake = mistake_of("[markers]\nC7 = \"c7\"\nC7 = \"t10\"\n");
  EXPECT_TRUE(mistake.starts_with("map.toml:3: not valid TOML: ")) << mistake;
}

}  // namespace
}  // namespace marey::recordings
