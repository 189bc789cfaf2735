// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Recordings of boards by other projects. The residual of a camera model that is fitted
// to the corners measures their accuracy; it is never less than their noise.
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "capture/boards/find_board_points.h"
#include "capture/video/frame_source.h"
#include "capture/video/open_frames.h"
#include "tests/support/program/paths.h"

namespace marey::capture {
namespace {

namespace fs = std::filesystem;
const fs::path kCamera = marey::testing::shared_data() / "camera";

/// Views of a board for OpenCV's calibration, by frame; squares are 1 wide.
struct Views {
  std::vector<std::vector<cv::Point3f>> on_board;
  std::vector<std::vector<cv::Point2f>> pixels;
  std::size_t points = 0;
  double sigma_squares = 0.0;

  [[nodiscard]] double sigma_px() const {
    return std::sqrt(sigma_squares / static_cast<double>(points));
  }
};

template <class Board>
Views views_in(const fs::path& path, const Board& board, std::size_t min_points) {
  Views views;
  auto finder = BoardFinder::create(board);
  auto source = open_frames(path);
  EXPECT_TRUE(finder && source) << path;
  for (auto next = (*source)->next(); next && *next; next = (*source)->next()) {
    const auto points = finder->find(**next);
    if (points.size() < min_points) continue;
    views.on_board.emplace_back();
    views.pixels.emplace_back();
    for (const PointDetection& point : points) {
      const auto p = inner_corner_in_board(board.rows, board.columns, 1.0, point.point);
      views.on_board.back().emplace_back(
          static_cast<float>(p->x), static_cast<float>(p->y), 0.0F);
      views.pixels.back().emplace_back(static_cast<float>(point.pixel_px.x),
                                       static_cast<float>(point.pixel_px.y));
      views.sigma_squares += point.sigma_px * point.sigma_px;
    }
    views.points += points.size();
  }
  return views;
}

struct Solved {
  double rms_px = 0.0;
  cv::Mat matrix;
  cv::Mat distortion;
};

Solved calibrated(const Views& views, const cv::Size& size) {
  Solved solved;
  std::vector<cv::Mat> turns;
  std::vector<cv::Mat> shifts;
  solved.rms_px = cv::calibrateCamera(views.on_board,
                                      views.pixels,
                                      size,
                                      solved.matrix,
                                      solved.distortion,
                                      turns,
                                      shifts);
  return solved;
}

// The 4 x 5 board of 54 mm squares, white on black, waved by a person in front of
// webcams.
TEST(RealBoards, CornersOfWebcamsFitACameraToATenthOfAPixel) {
  const fs::path session = kCamera / "caliscope/sessions/4_cam_recording";
  if (!fs::exists(session)) GTEST_SKIP() << "no " << session;
  CharucoBoard board;
  board.rows = 5;
  board.columns = 4;
  board.square_size_m = 0.054;
  board.marker_size_m = 0.0405;
  board.dictionary = "DICT_4X4_1000";
  board.is_inverted = true;
  board.is_two_sided = true;  // Camera 1 sees its back.
  const std::map<std::string, std::size_t> min_views{
      {"cam_0.mp4", 44}, {"cam_1.mp4", 42}, {"cam_2.mp4", 38}, {"cam_3.mp4", 20}};
  for (const auto& [name, minimum] : min_views) {
    SCOPED_TRACE(name);
    const Views views = views_in(session / "calibration/extrinsic" / name, board, 8);
    ASSERT_GE(views.pixels.size(), minimum);
    const Solved solved = calibrated(views, {1280, 720});
    EXPECT_LT(solved.rms_px, 0.1);
    // The root mean square of distances is that of coordinates times the root of two.
    const double in_sigmas = solved.rms_px / std::sqrt(2.0) / views.sigma_px();
    EXPECT_GT(in_sigmas, 0.6);
    EXPECT_LT(in_sigmas, 1.5);
  }
}

// OpenCV's own corners (cornerSubPix(), windows of 23 px) give 0.445 px and 3.338
// squares, some of them biased by neighbouring corners; without those, 0.20 px and 3.327.
// Leave-one-out over the pairs gives an uncertainty of the distance of 0.005 squares.
TEST(RealBoards, CornersOfOpenCvsStereoPairsFitBothCameras) {
  const fs::path folder = kCamera / "opencv_samples";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder;
  const Chessboard board{.rows = 7, .columns = 10, .square_size_m = 1.0};
  const Views left = views_in(folder / "left*.jpg", board, 54);
  const Views right = views_in(folder / "right*.jpg", board, 54);
  ASSERT_EQ(left.pixels.size(), 13U);
  ASSERT_EQ(right.pixels.size(), 13U);
  Solved a = calibrated(left, {640, 480});
  Solved b = calibrated(right, {640, 480});
  cv::Mat turn;
  cv::Mat shift;
  cv::Mat essential;
  cv::Mat fundamental;
  const double rms_px = cv::stereoCalibrate(left.on_board,
                                            left.pixels,
                                            right.pixels,
                                            a.matrix,
                                            a.distortion,
                                            b.matrix,
                                            b.distortion,
                                            {640, 480},
                                            turn,
                                            shift,
                                            essential,
                                            fundamental,
                                            cv::CALIB_USE_INTRINSIC_GUESS);
  EXPECT_LT(rms_px, 0.19);
  EXPECT_NEAR(cv::norm(shift), 3.327, 0.005);
}

}  // namespace
}  // namespace marey::capture
