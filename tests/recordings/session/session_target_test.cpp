// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "recordings/session/session.h"
#include "tests/recordings/session_text.h"
#include "tests/support/files/text_file.h"

namespace marey::recordings {
namespace {

/// Returns kSession with `target` in place of its board, which begins in line 18.
std::string with_target(std::string_view target) {
  std::string text(kSession);
  const std::size_t from = text.find("[board]");
  text.replace(from, text.find("[[camera]]") - from, target);
  return text;
}

constexpr std::string_view kCharuco = R"([board]
type = "charuco"
rows = 5
columns = 4
square_size_m = 0.054
marker_size_m = 0.0405
dictionary = "DICT_4X4_1000"
)";

constexpr std::string_view kChessboard = R"([board]
type = "chessboard"
rows = 7
columns = 10
square_size_m = 0.025
)";

constexpr std::string_view kWand = R"([wand]
family = "tag25h9"
[[wand.tag]]
id = 9
size_m = 0.12
[[wand.tag]]
id = 7
size_m = 0.1
family = "tag36h11"
)";

std::string target_with(std::string_view target,
                        std::string_view from,
                        std::string_view to) {
  return testing::replace_first(with_target(target), from, to);
}

TEST(SessionTarget, IsAnAprilGridWithoutAType) {
  const auto session = read(with("type = \"aprilgrid\"\n", ""));
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_TRUE(std::holds_alternative<AprilGrid>(session->target));
}

TEST(SessionTarget, MayBeACharucoBoard) {
  const auto session = read(with_target(kCharuco));
  ASSERT_TRUE(session) << session.error().message();
  const auto& board = std::get<CharucoBoard>(session->target);
  EXPECT_EQ(board.rows, 5);
  EXPECT_EQ(board.columns, 4);
  EXPECT_EQ(board.square_size_m, 0.054);
  EXPECT_EQ(board.marker_size_m, 0.0405);
  EXPECT_EQ(board.dictionary, "DICT_4X4_1000");
  EXPECT_FALSE(board.is_legacy || board.is_inverted || board.is_two_sided);
  // Its markers are no tags of the session.
  ASSERT_EQ(session->families.size(), 1U);
  EXPECT_EQ(session->families[0].ids.size(), 2U);
}

TEST(SessionTarget, MayBeAChessboard) {
  const auto session = read(with_target(kChessboard));
  ASSERT_TRUE(session) << session.error().message();
  const auto& board = std::get<Chessboard>(session->target);
  EXPECT_EQ(board.rows, 7);
  EXPECT_EQ(board.columns, 10);
  EXPECT_EQ(board.square_size_m, 0.025);
}

TEST(SessionTarget, MayBeAWand) {
  const auto session = read(with_target(kWand));
  ASSERT_TRUE(session) << session.error().message();
  const auto& wand = std::get<Wand>(session->target);
  ASSERT_EQ(wand.tags.size(), 2U);
  EXPECT_EQ(wand.tags[0].id, TagId{7});
  EXPECT_EQ(wand.tags[0].size_m, 0.1);
  EXPECT_EQ(wand.tags[1].id, TagId{9});
  EXPECT_EQ(session->family_of(TagId{7}), "tag36h11");
  EXPECT_EQ(session->family_of(TagId{9}), "tag25h9");
}

// kSession has tag 41 on the hips.
TEST(SessionTarget, MayBeASegmentOfTheBody) {
  const auto session = read(with_target("[wand]\nsegment = \"hips\"\n"));
  ASSERT_TRUE(session) << session.error().message();
  const auto& wand = std::get<Wand>(session->target);
  ASSERT_EQ(wand.tags.size(), 1U);
  EXPECT_EQ(wand.tags[0].id, TagId{41});
  EXPECT_EQ(wand.tags[0].size_m, session->tags[0].size_m);
}

TEST(SessionTarget, IsNoSegmentWithoutTags) {
  EXPECT_TRUE(mistake(with_target("[wand]\nsegment = \"leftFoot\"\n"))
                  .starts_with("session.toml:19: no tag is on the segment \"leftFoot\""));
  EXPECT_TRUE(mistake(with_target("[wand]\nsegment = \"leftFood\"\n"))
                  .starts_with("session.toml:19: unknown segment \"leftFood\""));
  EXPECT_TRUE(
      mistake(with_target(std::string("[wand]\nsegment = \"hips\"\n") +
                          "[[wand.tag]]\nid = 7\nsize_m = 0.1\n"))
          .starts_with("session.toml:19: the wand has tags of its own and is a segment"));
}

TEST(SessionTarget, DeclinesAnUnknownTypeAndSuggestsTheNearest) {
  EXPECT_EQ(mistake(target_with(kCharuco, "\"charuco\"", "\"charucoo\"")),
            "session.toml:19: unknown board type \"charucoo\". Next: perhaps you mean "
            "\"charuco\".");
}

TEST(SessionTarget, DeclinesAnUnknownDictionaryAndSuggestsTheNearest) {
  EXPECT_EQ(
      mistake(target_with(kCharuco, "DICT_4X4_1000", "dict_4x4_1000")),
      "session.toml:24: unknown dictionary \"dict_4x4_1000\". Next: perhaps you mean "
      "\"DICT_4X4_1000\".");
}

TEST(SessionTarget, HasTheKeysOfItsTypeAlone) {
  EXPECT_TRUE(mistake(target_with(kCharuco, "rows = 5", "rows = 5\ngap_m = 0.1"))
                  .starts_with("session.toml:21: unknown key \"gap_m\" in [board]"));
  EXPECT_TRUE(mistake(target_with(kChessboard, "rows = 7", "rows = 7\nlegacy = true"))
                  .starts_with("session.toml:21: unknown key \"legacy\" in [board]"));
}

TEST(SessionTarget, WithMarkersAsLargeAsSquaresIsRefused) {
  EXPECT_TRUE(mistake(target_with(kCharuco, "0.0405", "0.054"))
                  .starts_with("session.toml:23: a marker is as large as its square"));
}

TEST(SessionTarget, WithMoreMarkersThanItsDictionaryIsRefused) {
  std::string text = target_with(kCharuco, "rows = 5", "rows = 30");
  text.replace(text.find("DICT_4X4_1000"), 13, "DICT_4X4_50");
  EXPECT_TRUE(mistake(text).starts_with(
      "session.toml:24: the board needs 60 markers, and DICT_4X4_50 has 50"));
}

TEST(SessionTarget, ThatLooksTheSameAfterHalfATurnIsRefused) {
  const std::string message = mistake(target_with(kChessboard, "rows = 7", "rows = 6"));
  EXPECT_TRUE(message.starts_with(
      "session.toml:20: a chessboard of 10 x 6 squares looks the same after half a turn"))
      << message;
}

TEST(SessionTarget, RefusesABoardWithASingleCorner) {
  std::string text = target_with(kCharuco, "rows = 5", "rows = 2");
  text.replace(text.find("columns = 4"), 11, "columns = 2");
  EXPECT_TRUE(mistake(text).starts_with("session.toml:20: a board of 2 x 2 squares"));
}

TEST(SessionTarget, IsABoardOrAWand) {
  const std::string both = std::string(kCharuco).append(kWand);
  EXPECT_TRUE(mistake(with_target(both))
                  .starts_with("session.toml:25: the session has a board and a wand"));
  EXPECT_TRUE(mistake(with_target("")).find("\"board\"") != std::string::npos);
}

TEST(SessionTarget, HasNoTagThatIsOnTheBodyToo) {
  EXPECT_TRUE(mistake(target_with(kWand, "id = 7\n", "id = 73\n"))
                  .starts_with("session.toml:15: tag 73 is on the body and on the wand"));
  EXPECT_TRUE(mistake(target_with(kWand, "id = 7\n", "id = 9\n"))
                  .starts_with("session.toml:24: tag 9 is on the wand twice"));
  // OpenCV's AprilTags are those of libapriltag.
  std::string text = target_with(kCharuco, "DICT_4X4_1000", "DICT_APRILTAG_36h11");
  text.replace(text.find("id = 73"), 7, "id = 3");
  EXPECT_TRUE(
      mistake(text).starts_with("session.toml:15: tag 3 is on the body and on the board"))
      << mistake(text);
}

TEST(SessionTarget, IsEnoughForASessionWithoutAPerson) {
  std::string text = with_target(kCharuco);
  const std::size_t subject = text.find("[subject]");
  text.erase(subject, text.find("[board]") - subject);
  text.erase(text.find("[[trial]]\nname = \"floor\""));
  const auto session = read(text);
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_TRUE(session->tags.empty());
  EXPECT_TRUE(session->families.empty());
  ASSERT_EQ(session->trials.size(), 1U);
}

}  // namespace
}  // namespace marey::recordings
