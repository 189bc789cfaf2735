// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/labels/apply_map.h"

#include <initializer_list>

#include <gtest/gtest.h>

#include "reconstruct/labels/name_markers.h"
#include "tests/reconstruct/labels/named_labels.h"

namespace marey::reconstruct {
namespace {

using testing::name_of;
using testing::words;

MarkerMap map_of(std::initializer_list<MarkerMapEntry> entries) {
  return {"map.toml", entries};
}

TEST(ApplyMap, CorrectsAndAddsAndLeavesOut) {
  const auto labels = words("Bob:LASI Bob:RASI Bob:LTOE Bob:X1 Bob:X2");
  const auto names = apply_map(
      map_of(
          {{"LTOE", "left_big_toe", 2}, {"Bob:X1", "leftUpperLeg", 3}, {"RASI", "", 4}}),
      labels,
      name_markers(labels));
  ASSERT_TRUE(names) << names.error().message();
  EXPECT_EQ(name_of(labels, *names, "Bob:LASI"), "left_asis");
  EXPECT_EQ(name_of(labels, *names, "Bob:RASI"), "");
  EXPECT_EQ(name_of(labels, *names, "Bob:LTOE"), "left_big_toe");
  EXPECT_EQ(name_of(labels, *names, "Bob:X1"), "left_thigh");
  EXPECT_EQ(name_of(labels, *names, "Bob:X2"), "");
  EXPECT_TRUE(names->notes.empty());
}

TEST(ApplyMap, ReportsLabelsThatTheRecordingLacks) {
  const auto labels = words("LASI RASI");
  const auto names = apply_map(map_of({{"LASI", "left_asis", 2}, {"LASSI", "c7", 3}}),
                               labels,
                               name_markers(labels));
  ASSERT_TRUE(names);
  ASSERT_EQ(names->notes.size(), 1U);
  EXPECT_EQ(names->notes[0], "the recording has no marker \"LASSI\" (map.toml:3)");
}

TEST(ApplyMap, RefusesAnUnknownNameWithThoseNearToIt) {
  const auto labels = words("LASI RASI");
  const auto names =
      apply_map(map_of({{"LASI", "left_asia", 7}}), labels, name_markers(labels));
  ASSERT_FALSE(names);
  EXPECT_EQ(
      names.error().message(),
      "map.toml:7: no landmark and no bone is called \"left_asia\". Next: perhaps "
      "you mean \"left_asis\", \"left_psis\" or \"left_rib\"; docs/formats/README.md "
      "lists all.");
}

TEST(ApplyMap, RefusesAMapOfAnotherRecording) {
  const auto labels = words("LASI RASI");
  const auto names =
      apply_map(map_of({{"hip1", "left_asis", 2}, {"hip2", "right_asis", 3}}),
                labels,
                name_markers(labels));
  ASSERT_FALSE(names);
  EXPECT_EQ(
      names.error().message(),
      "map.toml:2: the recording has none of these labels. Next: marey inspect lists "
      "the labels of a recording.");
  EXPECT_TRUE(apply_map(map_of({}), labels, name_markers(labels)));
}

}  // namespace
}  // namespace marey::reconstruct
