// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/print/print_tags.h"

#include <cmath>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/recordings/print/print_laws.h"

namespace marey::recordings {
namespace {

TagToPrint tag(int id,
               double size_m,
               const TagFamilyShape& family = black_family(),
               std::optional<HumanBone> segment = std::nullopt) {
  return {TagId{id}, segment, size_m, family, synthetic_pattern(family, id)};
}

std::vector<TagToPrint> tags(int count, double size_m, const TagFamilyShape& family) {
  std::vector<TagToPrint> out;
  for (int id = 0; id < count; ++id) out.push_back(tag(id, size_m, family));
  return out;
}

void expect_each_once(const PrintedDocument& document, const TagSheet& sheet) {
  std::map<TagId, double> sizes;
  for (const PrintedPage& page : document.pages) {
    EXPECT_FALSE(page.tags.empty() && !sheet.plates);
    for (const PrintedTag& printed : page.tags) {
      EXPECT_TRUE(sizes.emplace(printed.id, printed.square.width()).second);
      EXPECT_NEAR(printed.square.width(), printed.square.height(), kRoundingM);
    }
  }
  ASSERT_EQ(sizes.size(), sheet.tags.size());
  for (const TagToPrint& wanted : sheet.tags) {
    EXPECT_NEAR(sizes.at(wanted.id), wanted.size_m, kRoundingM);
  }
}

const std::vector<Paper> kPapers{{"A4", 0.210, 0.297, 0.010},
                                 {"Letter", 0.2159, 0.2794, 0.012},
                                 {"A3", 0.297, 0.420, 0.005},
                                 {"150x300mm", 0.150, 0.300, 0.010}};

// Sizes from a coin to a full page; both kinds of families.
TEST(PrintTags, KeepLayoutLaws) {
  for (const Paper& paper : kPapers) {
    for (const TagFamilyShape& family : {black_family(), white_family()}) {
      for (const double size_m : {0.008, 0.021, 0.04, 0.055}) {
        SCOPED_TRACE(paper.name + " " + family.name + " " + std::to_string(size_m));
        const TagSheet sheet{tags(23, size_m, family), paper, false};
        const auto document = lay_out_tags(sheet);
        ASSERT_TRUE(document) << document.error().message();
        expect_lawful(*document, paper, true);
        expect_each_once(*document, sheet);
      }
    }
  }
}

TEST(PrintTags, KeepLayoutLawsForManySizes) {
  TagSheet sheet;
  for (int id = 0; id < 40; ++id) {
    sheet.tags.push_back(tag(id,
                             0.015 + 0.0021 * ((id * 7) % 40),
                             id % 3 == 0 ? white_family() : black_family(),
                             human_bones()[static_cast<std::size_t>(id % 22)]));
    if (sheet.tags.back().family.white_square) sheet.tags.back().size_m *= 0.5;
  }
  const auto document = lay_out_tags(sheet);
  ASSERT_TRUE(document) << document.error().message();
  expect_lawful(*document, sheet.paper, true);
  expect_each_once(*document, sheet);
}

// 40 mm tags are 50 mm wide with their quiet zones and 55 mm high with their names: of
// 210 x 297 mm less margins, header and footer three columns of four fit upright.
TEST(PrintTags, FillThePage) {
  const auto document = lay_out_tags({tags(100, 0.040, black_family()), {}, false});
  ASSERT_TRUE(document);
  EXPECT_EQ(document->pages.front().tags.size(), 12U);
  EXPECT_EQ(document->pages.size(), 9U);
}

TEST(PrintTags, LieDownWhereThatNeedsFewerPages) {
  // Two of 94 x 103 mm fit next to each other only across the long edge.
  const Paper paper{"150x230mm", 0.150, 0.230, 0.0};
  const auto document = lay_out_tags({tags(2, 0.075, black_family()), paper, false});
  ASSERT_TRUE(document) << document.error().message();
  EXPECT_EQ(document->pages.size(), 1U);
}

TEST(PrintTags, LargerThanThePageAreRefusedWithThePageThatWouldDo) {
  const auto document = lay_out_tags({tags(2, 0.19, black_family()), {}, false});
  ASSERT_FALSE(document);
  EXPECT_EQ(document.error().code, Errc::kBadInput);
  EXPECT_NE(document.error().next.find("--page A3"), std::string::npos)
      << document.error().message();
  const auto larger = lay_out_tags({tags(2, 0.5, black_family()), {}, false});
  ASSERT_FALSE(larger);
  EXPECT_NE(larger.error().next.find("--page 649x"), std::string::npos)
      << larger.error().message();
}

TEST(PrintTags, OnPaperWithoutRoomForTheRulerAreRefused) {
  const Paper paper{"100x300mm", 0.100, 0.300, 0.010};
  const auto document = lay_out_tags({tags(1, 0.02, black_family()), paper, false});
  ASSERT_FALSE(document);
  EXPECT_NE(document.error().cause.find("ruler"), std::string::npos);
}

TEST(PrintTags, AsPlatesKeepLayoutLaws) {
  for (const double size_m : {0.02, 0.04, 0.06, 0.08}) {
    SCOPED_TRACE(size_m);
    const TagSheet sheet{tags(6, size_m, black_family()), {}, true};
    const auto document = lay_out_tags(sheet);
    ASSERT_TRUE(document) << document.error().message();
    expect_each_once(*document, sheet);
    expect_lawful(*document, sheet.paper, false);
  }
}

/// Returns how many texts of the document contain `text`.
int count_of(const PrintedDocument& document, const std::string& text) {
  int count = 0;
  for (const PrintedPage& page : document.pages) {
    for (const PrintedShape& shape : page.shapes) {
      const auto* words = std::get_if<PrintedText>(&shape);
      if (words != nullptr && words->text.find(text) != std::string::npos) ++count;
    }
  }
  return count;
}

// Two tags of a forearm, one of the other, three of the hips: one plate.
TEST(PrintTags, OnlyPairsOfALimbBecomePlates) {
  const TagFamilyShape family = black_family();
  const TagSheet sheet{{tag(1, 0.04, family, HumanBone::kLeftLowerArm),
                        tag(2, 0.04, family, HumanBone::kHips),
                        tag(3, 0.04, family, HumanBone::kLeftLowerArm),
                        tag(4, 0.04, family, HumanBone::kHips),
                        tag(5, 0.04, family, HumanBone::kRightLowerArm),
                        tag(6, 0.05, family, HumanBone::kRightLowerArm)},
                       {},
                       true};
  const auto document = lay_out_tags(sheet);
  ASSERT_TRUE(document) << document.error().message();
  expect_each_once(*document, sheet);
  EXPECT_EQ(count_of(*document, "Base for"), 1);
  EXPECT_EQ(count_of(*document, "Base for 1 and 3"), 1);
}

// The base of a roof of two faces of width w at a right angle is w times the root of 2.
TEST(PrintTags, FacesOfAPlateAreAtARightAngle) {
  const auto document = lay_out_tags({tags(2, 0.04, black_family()), {}, true});
  ASSERT_TRUE(document);
  std::vector<double> widths;
  std::set<double> folds;
  for (const PrintedShape& shape : document->pages.front().shapes) {
    const auto* line = std::get_if<PrintedLine>(&shape);
    if (line == nullptr) continue;
    if (line->closed) widths.push_back(around(line->points, 0.0).width());
    if (line->dashed) folds.insert(line->points.front().x);
  }
  ASSERT_EQ(widths.size(), 2U);
  ASSERT_EQ(folds.size(), 3U);
  const double left_face = *std::next(folds.begin()) - *folds.begin();
  const double right_face = *folds.rbegin() - *std::next(folds.begin());
  EXPECT_NEAR(left_face, right_face, kRoundingM);
  EXPECT_NEAR(std::min(widths[0], widths[1]), std::sqrt(2.0) * left_face, kRoundingM);
}

TEST(PrintTags, ShowTheirSegments) {
  const auto document =
      lay_out_tags({{tag(41, 0.09, black_family(), HumanBone::kHips)}, {}, false});
  ASSERT_TRUE(document);
  EXPECT_EQ(count_of(*document, "41  hips"), 1);
  EXPECT_EQ(count_of(*document, "90 mm"), 2);  // In the title and below the tag.
}

}  // namespace
}  // namespace marey::recordings
