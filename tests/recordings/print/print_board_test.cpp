// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/print/print_board.h"

#include <set>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/detection.h"
#include "recordings/session/session.h"
#include "tests/recordings/print/print_laws.h"
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

/// Returns the position of a tag's corner, from the lower left corner of the page.
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

// Two neighbouring pages, aligned edge to ticks, agree in their overlap: tags on both
// pages have equal distances from the seam.
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
  // The recommended paper is large enough.
  EXPECT_TRUE(printed({6, 6, 0.03, 0.009, 0, 0.0}, {{"A3", 0.297, 0.42, 0.01}, true}));
}

TEST(PrintBoard, RefusesTagsLargerThanThePage) {
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

/// Returns the session of kSession with this table in place of its own.
Result<Session> session_with(const std::string& table) {
  std::string session(kSession);
  const std::size_t from = session.find("[board]");
  const std::size_t to = session.find("[[", from);
  EXPECT_NE(to, std::string::npos);
  session.replace(from, to - from, table);
  return read(session);
}

TEST(PrintBoard, WritesATableThatSessionsRead) {
  const AprilGrid grid{4, 3, 0.0515, 0.0154, 400, 0.0045};
  const auto session = session_with(board_table(grid, "tag36h11b2"));
  ASSERT_TRUE(session) << session.error().message();
  const auto& read = std::get<AprilGrid>(session->target);
  EXPECT_EQ(read.rows, grid.rows);
  EXPECT_EQ(read.columns, grid.columns);
  EXPECT_EQ(read.tag_size_m, grid.tag_size_m);
  EXPECT_EQ(read.gap_m, grid.gap_m);
  EXPECT_EQ(read.first_id, grid.first_id);
  EXPECT_EQ(read.thickness_m, grid.thickness_m);
  EXPECT_EQ(session->family_of(TagId{400}), "tag36h11b2");
}

TEST(PrintBoard, WritesATableOfSquaresThatSessionsRead) {
  const CharucoBoard board{.rows = 6,
                           .columns = 8,
                           .square_size_m = 0.0311,
                           .marker_size_m = 0.0233,
                           .dictionary = "DICT_6X6_250",
                           .is_legacy = true,
                           .is_inverted = true,
                           .is_two_sided = true,
                           .thickness_m = 0.003};
  const auto session = session_with(board_table(board));
  ASSERT_TRUE(session) << session.error().message();
  const auto& read = std::get<CharucoBoard>(session->target);
  EXPECT_EQ(read.rows, board.rows);
  EXPECT_EQ(read.columns, board.columns);
  EXPECT_EQ(read.square_size_m, board.square_size_m);
  EXPECT_EQ(read.marker_size_m, board.marker_size_m);
  EXPECT_EQ(read.dictionary, board.dictionary);
  EXPECT_TRUE(read.is_legacy);
  EXPECT_TRUE(read.is_inverted);
  EXPECT_TRUE(read.is_two_sided);
  EXPECT_EQ(read.thickness_m, board.thickness_m);

  const Chessboard plain{
      .rows = 6, .columns = 9, .square_size_m = 0.0311, .thickness_m = 0.002};
  const auto other = session_with(board_table(plain));
  ASSERT_TRUE(other) << other.error().message();
  const auto& read_plain = std::get<Chessboard>(other->target);
  EXPECT_EQ(read_plain.rows, plain.rows);
  EXPECT_EQ(read_plain.columns, plain.columns);
  EXPECT_EQ(read_plain.square_size_m, plain.square_size_m);
  EXPECT_EQ(read_plain.thickness_m, plain.thickness_m);
}

/// A board for an A4 page.
CharucoBoard charuco() {
  return {.rows = 7,
          .columns = 5,
          .square_size_m = 0.030,
          .marker_size_m = 0.022,
          .dictionary = "DICT_5X5_100"};
}

std::vector<TagPattern> markers(const CharucoBoard& board) {
  return patterns(board.marker_count(), {"marker", 100, 7, 7, false});
}

TEST(PrintBoard, KeepsLayoutLawsForSquaresWithMarkers) {
  const CharucoBoard board = charuco();
  const auto document = lay_out_board(board, markers(board), {{}, true});
  ASSERT_TRUE(document) << document.error().message();
  expect_lawful(*document, {}, false);
  EXPECT_EQ(document->pages.front().tags.size(), 17U);
}

TEST(PrintBoard, WithMarkersAsLargeAsSquaresIsRefused) {
  CharucoBoard board = charuco();
  board.marker_size_m = 0.031;
  const auto document = lay_out_board(board, markers(board), {});
  ASSERT_FALSE(document);
  EXPECT_NE(document.error().next.find("26.25 mm or less"), std::string::npos)
      << document.error().message();
}

TEST(PrintBoard, PutsLegacyMarkersInTheOtherSquares) {
  CharucoBoard board = charuco();
  board.rows = 6;
  const auto modern = lay_out_board(board, markers(board), {{}, true});
  board.is_legacy = true;
  const auto old = lay_out_board(board, markers(board), {{}, true});
  ASSERT_TRUE(modern && old);
  // The first marker is in the top left square, or in the one next to it.
  const double step = modern->pages.front().tags.front().square.left -
                      old->pages.front().tags.front().square.left;
  EXPECT_NEAR(step, board.square_size_m, 1e-9);
}

TEST(PrintBoard, InvertedIsRefused) {
  CharucoBoard board = charuco();
  board.is_inverted = true;
  const auto document = lay_out_board(board, markers(board), {});
  ASSERT_FALSE(document);
  EXPECT_NE(document.error().cause.find("white on black"), std::string::npos);
}

TEST(PrintBoard, KeepsLayoutLawsForPlainSquares) {
  const Chessboard board{.rows = 7, .columns = 6, .square_size_m = 0.025};
  const auto document = lay_out_board(board, {{}, true});
  ASSERT_TRUE(document) << document.error().message();
  expect_lawful(*document, {}, false);
}

TEST(PrintBoard, ThatLooksTheSameAfterHalfATurnIsRefused) {
  const auto document =
      lay_out_board(Chessboard{.rows = 7, .columns = 5, .square_size_m = 0.025}, {});
  ASSERT_FALSE(document);
  EXPECT_NE(document.error().cause.find("half a turn"), std::string::npos);
}

}  // namespace
}  // namespace marey::recordings
