// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "capture/search/find_board_elsewhere.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "capture/search/survey_boards.h"
#include "core/base/frame_range.h"
#include "tests/capture/tag_artist.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::capture {
namespace {

using testing::ScratchFolder;

const AprilGrid kGrid{2, 3, 0.1, 0.03, 0, 0.0};

cv::Mat empty_picture() {
  return tests::draw_tags(640, 480, {});
}

/// The grid's tags, upright.
cv::Mat picture_of(const std::string& family) {
  std::vector<tests::DrawnTag> tags;
  for (int id = 0; id < kGrid.tag_count(); ++id) {
    const glm::dvec2 middle(150.0 + 150.0 * (id % kGrid.columns),
                            330.0 - 150.0 * static_cast<double>(id / kGrid.columns));
    tags.push_back({family, id, tests::square(middle, 90.0)});
  }
  return tests::draw_tags(640, 480, tags);
}

/// Writes a folder of images; returns the pattern of their names.
std::filesystem::path record(const ScratchFolder& folder,
                             const std::vector<cv::Mat>& pictures) {
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const auto name = std::to_string(i) + ".png";
    EXPECT_TRUE(cv::imwrite((folder / name).string(), pictures[i]));
  }
  return folder.path();
}

TEST(FindBoardElsewhere, DetectsAMirroredVideo) {
  for (const int axis : {0, 1}) {
    const ScratchFolder folder;
    cv::Mat mirrored;
    cv::flip(picture_of("tag36h11"), mirrored, axis);
    const auto path = record(folder, {mirrored, empty_picture(), mirrored});
    const auto seen = find_board_elsewhere(path, kGrid, "tag36h11", std::nullopt);
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->kind, AlternativeKind::kAprilGrid);
    EXPECT_EQ(seen->codes, "tag36h11");
    EXPECT_TRUE(seen->is_mirrored);
    EXPECT_EQ(seen->what,
              "the mirror image of 2 of 3 frames shows its tags: the video is mirrored");
    EXPECT_NE(seen->remedy.find("switch off mirroring"), std::string::npos);
  }
}

TEST(FindBoardElsewhere, SearchesFramesOutsideTheRange) {
  const ScratchFolder folder;
  const cv::Mat board = picture_of("tag36h11");
  const auto path = record(folder, {board, empty_picture(), empty_picture(), board});
  const auto seen = find_board_elsewhere(path, kGrid, "tag36h11", FrameRange{1, 2});
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->kind, AlternativeKind::kExpected);
  EXPECT_EQ(seen->what, "the board is in 2 of 4 frames from all over the video");
  EXPECT_NE(seen->remedy.find("widen `frames`"), std::string::npos);
}

TEST(FindBoardElsewhere, ReturnsTheFamilyInView) {
  const ScratchFolder folder;
  const auto path = record(folder, {picture_of("tag36h11")});
  const auto seen = find_board_elsewhere(path, kGrid, "tag36h11b2", std::nullopt);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->kind, AlternativeKind::kAprilGrid);
  EXPECT_EQ(seen->codes, "tag36h11");
  EXPECT_FALSE(seen->is_mirrored);
  EXPECT_NE(seen->what.find("tags of family tag36h11 are in 1 of 1"), std::string::npos)
      << seen->what;
  EXPECT_EQ(seen->remedy, "write family = \"tag36h11\" in [board] of session.toml");
}

TEST(FindBoardElsewhere, ReturnsNothingWithoutABoard) {
  const ScratchFolder folder;
  const auto path = record(folder, {empty_picture()});
  EXPECT_FALSE(find_board_elsewhere(path, kGrid, "tag36h11", FrameRange{0, 0}));
  EXPECT_FALSE(find_board_elsewhere(folder / "nothing", kGrid, "tag36h11", std::nullopt));
}

}  // namespace
}  // namespace marey::capture
