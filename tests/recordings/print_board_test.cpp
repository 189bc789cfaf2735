// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/print_board.h"

#include <set>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/detection.h"
#include "recordings/session.h"
#include "tests/recordings/print_laws.h"
#include "tests/recordings/session_text.h"

namespace marey::recordings {
namespace {

std::vector<TagPattern> patterns(int count, const TagFamilyShape& family) {
  std::vector<TagPattern> out;
  for (int i = 0; i < count; ++i) out.push_back(synthetic_pattern(family, i));
  return out;
}

Result<PrintedDocument> printed(const AprilGrid& grid,
                                const BoardPages& pages = {},
                                const TagFamilyShape& family = black_family()) {
  return lay_out_board(grid, family, patterns(grid.tag_count(), family), pages);
}

/// Where a corner of a tag is, from the lower left corner of the page.
glm::dvec2 corner_on(const PrintedPage& page, const PrintedTag& tag, int corner) {
  const auto& side = kCornerSides[static_cast<std::size_t>(corner)];
  return {side[0] < 0 ? tag.square.left : tag.square.right,
          page.height_m - (side[1] < 0 ? tag.square.top : tag.square.bottom)};
}

TEST(PrintBoard, PutsEachCornerWhereTheGridHasIt) {
  for (const TagFamilyShape& family : {black_family(), white_family()}) {
    const double size_m = family.white_square ? 0.012 : 0.022;
    const AprilGrid grid{5, 6, size_m, family.white_square ? 0.014 : 0.0066, 7, 0.0};
    const auto document = printed(grid, {}, family);
    ASSERT_TRUE(document) << document.error().message();
    ASSERT_EQ(document->pages.size(), 1U);
    const PrintedPage& page = document->pages.front();
    ASSERT_EQ(page.tags.size(), 30U);
    const glm::dvec2 origin = corner_on(page, page.tags.front(), 0);
    for (const PrintedTag& tag : page.tags) {
      for (int corner = 0; corner < 4; ++corner) {
        const glm::dvec3 wanted = *grid.corner_in_board(tag.id, corner);
        const glm::dvec2 found = corner_on(page, tag, corner) - origin;
        EXPECT_LT(glm::distance(found, glm::dvec2(wanted)), kRoundingM);
      }
    }
  }
}

TEST(PrintBoard, OnOnePageKeepsLayoutLaws) {
  for (const Paper& paper : {Paper{}, Paper{"Letter", 0.2159, 0.2794, 0.01}}) {
    const auto document = printed({6, 6, 0.022, 0.0066, 0, 0.0}, {paper, true});
    ASSERT_TRUE(document) << document.error().message();
    expect_lawful(*document, paper, true);
  }
}

TEST(PrintBoard, LargerThanThePageIsTiledAndWholeAgain) {
  const AprilGrid grid{6, 6, 0.1, 0.03, 0, 0.005};
  const auto document = printed(grid);
  ASSERT_TRUE(document) << document.error().message();
  EXPECT_GT(document->pages.size(), 6U);
  expect_lawful(*document, {}, false);
  std::set<TagId> whole;
  for (const PrintedPage& page : document->pages) {
    for (const PrintedTag& tag : page.tags) {
      whole.insert(tag.id);
      EXPECT_NEAR(tag.square.width(), 0.1, kRoundingM);
    }
  }
  EXPECT_EQ(whole.size(), 36U);  // Seams are in gaps: each tag is whole somewhere.
}

// Two neighbouring pages, laid edge to ticks, show the same where they overlap: tags
// that are on both are as far from the seam on either.
TEST(PrintBoard, PagesOverlapAtTheSeam) {
  const AprilGrid grid{2, 12, 0.03, 0.01, 0, 0.0};
  const auto document = printed(grid);
  ASSERT_TRUE(document);
  ASSERT_EQ(document->pages.size(), 2U);
  const PrintedPage& left = document->pages[0];
  const PrintedPage& right = document->pages[1];
  double tick = 0.0;
  for (const PrintedShape& shape : left.shapes) {
    const auto* words = std::get_if<PrintedText>(&shape);
    if (words != nullptr && words->text == "edge of page 2") tick = words->at.x + 0.001;
  }
  ASSERT_GT(tick, 0.0);
  double edge = 1.0;  // The corner marks' lines up and down.
  for (const PrintedShape& shape : right.shapes) {
    const auto* line = std::get_if<PrintedLine>(&shape);
    if (line == nullptr || line->ink != Ink::kFaint) continue;
    if (line->points[0].x == line->points[1].x) edge = std::min(edge, line->points[0].x);
  }
  const PrintedTag& last = left.tags[left.tags.size() / 2 - 1];
  const PrintedTag& first = right.tags.front();
  const double across = (tick - last.square.right) + (first.square.left - edge);
  EXPECT_EQ(number(first.id), number(last.id) + 1);
  EXPECT_NEAR(across, grid.gap_m, kRoundingM);
}

TEST(PrintBoard, OnOnePageOnlyIsRefusedWithThePageThatWouldDo) {
  const auto document = printed({6, 6, 0.1, 0.03, 0, 0.0}, {{}, true});
  ASSERT_FALSE(document);
  EXPECT_NE(document.error().next.find("--page 810x8"), std::string::npos)
      << document.error().message();
  const auto smaller = printed({6, 6, 0.03, 0.009, 0, 0.0}, {{}, true});
  ASSERT_FALSE(smaller);
  EXPECT_NE(smaller.error().next.find("--page A3"), std::string::npos)
      << smaller.error().message();
  // What is named does hold it.
  EXPECT_TRUE(printed({6, 6, 0.03, 0.009, 0, 0.0}, {{"A3", 0.297, 0.42, 0.01}, true}));
}

TEST(PrintBoard, OfTagsLargerThanThePageIsRefused) {
  const auto document = printed({1, 2, 0.4, 0.1, 0, 0.0});
  ASSERT_FALSE(document);
  EXPECT_EQ(document.error().code, Errc::kBadInput);
  EXPECT_NE(document.error().next.find("--page "), std::string::npos);
}

TEST(PrintBoard, WithoutRoomForQuietZonesIsRefused) {
  const auto document = printed({6, 6, 0.022, 0.0027, 0, 0.0});
  ASSERT_FALSE(document);
  EXPECT_NE(document.error().next.find("2.75 mm"), std::string::npos)
      << document.error().message();
}

// The table in a session, in place of its own, makes the session's board this one.
TEST(PrintBoard, TableIsWhatSessionsRead) {
  const AprilGrid grid{4, 3, 0.0515, 0.0154, 400, 0.0045};
  std::string session(kSession);
  const std::size_t from = session.find("[board]");
  const std::size_t to = session.find("[[", from);
  ASSERT_NE(to, std::string::npos);
  session.replace(from, to - from, board_table(grid));
  const testing::ScratchFolder folder;
  ASSERT_TRUE(write_file(folder / "session.toml", session));
  const auto read = read_session(folder.path());
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->board.rows, grid.rows);
  EXPECT_EQ(read->board.columns, grid.columns);
  EXPECT_EQ(read->board.tag_size_m, grid.tag_size_m);
  EXPECT_EQ(read->board.gap_m, grid.gap_m);
  EXPECT_EQ(read->board.first_id, grid.first_id);
  EXPECT_EQ(read->board.thickness_m, grid.thickness_m);
}

std::vector<TagPattern> markers(const CharucoBoard& board) {
  return patterns(board.marker_count(), {"marker", 100, 7, 7, false});
}

TEST(PrintBoard, OfSquaresKeepsLayoutLaws) {
  const CharucoBoard board;
  const auto document = lay_out_board(board, markers(board), {{}, true});
  ASSERT_TRUE(document) << document.error().message();
  expect_lawful(*document, {}, false);
  EXPECT_EQ(document->pages.front().tags.size(), 17U);
}

TEST(PrintBoard, WithMarkersAsLargeAsSquaresIsRefused) {
  CharucoBoard board;
  board.marker_m = 0.031;
  const auto document = lay_out_board(board, markers(board), {});
  ASSERT_FALSE(document);
  EXPECT_NE(document.error().next.find("26.25 mm or less"), std::string::npos)
      << document.error().message();
}

}  // namespace
}  // namespace marey::recordings
