// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/print/print_words.h"

#include <string>

#include <gtest/gtest.h>

namespace marey::recordings {
namespace {

TEST(PrintWords, LengthsHaveUnits) {
  // Equal to the value read from session.toml.
  EXPECT_EQ(*parse_length_m("18mm"), 0.018);
  EXPECT_EQ(*parse_length_m("6.6mm"), 0.0066);
  EXPECT_NEAR(*parse_length_m(" 8 cm "), 0.080, 1e-15);
  EXPECT_NEAR(*parse_length_m("3.15in"), 0.08001, 1e-15);
  EXPECT_NEAR(*parse_length_m("0.08m"), 0.080, 1e-15);
}

TEST(PrintWords, LengthsWithoutUnitAreRefused) {
  const auto length = parse_length_m("80");
  ASSERT_FALSE(length);
  EXPECT_EQ(length.error().cause, "\"80\" has no unit");
  EXPECT_EQ(length.error().next, "write 80mm, 80cm or 80in");
}

TEST(PrintWords, InvalidLengthsAreRejected) {
  for (const char* text :
       {"", "mm", "80ft", "80 mm x", "-80mm", "0mm", "nan mm", "1e9mm"}) {
    EXPECT_FALSE(parse_length_m(text)) << text;
  }
}

TEST(PrintWords, PagesHaveNamesOrEdges) {
  EXPECT_EQ(parse_paper("a4")->name, "A4");
  EXPECT_NEAR(parse_paper("Letter")->height_m, 0.2794, 1e-12);
  const auto paper = parse_paper("210x297mm");
  ASSERT_TRUE(paper);
  EXPECT_NEAR(paper->width_m, 0.210, 1e-12);
  EXPECT_NEAR(paper->height_m, 0.297, 1e-12);
  for (const char* text : {"A5", "210x297", "210mm", "x297mm", "0x10mm", "9x9m"}) {
    EXPECT_FALSE(parse_paper(text)) << text;
  }
}

TEST(PrintWords, IdsAreListsAndRanges) {
  const auto tags = parse_tags("40-42,90, 7:hips");
  ASSERT_TRUE(tags) << tags.error().message();
  ASSERT_EQ(tags->size(), 5U);
  EXPECT_EQ(number((*tags)[2].id), 42);
  EXPECT_EQ(number((*tags)[3].id), 90);
  EXPECT_EQ((*tags)[4].segment, HumanBone::kHips);
  EXPECT_FALSE((*tags)[0].segment);
}

TEST(PrintWords, InvalidIdsAreRejected) {
  for (const char* text :
       {"", "a", "1,", "1,,2", "5-3", "-3", "1-2-3", "1,1", "3:", "0-99999", "1.5"}) {
    EXPECT_FALSE(parse_tags(text)) << text;
  }
  const auto wrong = parse_tags("41:hip");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().next.find("hips"), std::string::npos);
}

}  // namespace
}  // namespace marey::recordings
