// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/app/process/painted_session.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <utility>

#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/support/program/paths.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

constexpr int kCameras = 3;
constexpr int kMargin = static_cast<int>(2 * kPixelsPerCm);

int pixels(double cm) {
  return static_cast<int>(std::lround(cm * kPixelsPerCm));
}

cv::Mat white(double width_cm, double height_cm) {
  return {pixels(height_cm) + 2 * kMargin,
          pixels(width_cm) + 2 * kMargin,
          CV_8UC1,
          cv::Scalar(235)};
}

cv::Mat tag(int id, int side_px) {
  cv::Mat picture;
  cv::aruco::drawMarker(
      cv::aruco::getPredefinedDictionary(cv::aruco::DICT_APRILTAG_36h11),
      id,
      side_px,
      picture);
  // The dictionary's tags are libapriltag's upside down.
  cv::rotate(picture, picture, cv::ROTATE_180);
  return picture;
}

/// Picture from board [m], whose origin is the middle of the print, at a moment.
cv::Matx33d picture_from_board(int camera, double moment) {
  const cv::Matx33d k(560.0, 0.0, 320.0, 0.0, 560.0, 240.0, 0.0, 0.0, 1.0);
  const cv::Vec3d turn(
      0.5 * std::sin(1.3 * moment), 0.5 * std::sin(0.9 * moment + 1.0), 0.1 * moment);
  const cv::Vec3d place(0.10 * std::sin(1.7 * moment),
                        0.08 * std::cos(1.1 * moment),
                        0.75 + 0.12 * std::sin(0.7 * moment));
  const double angle = 0.35 * (camera - 1);
  const cv::Vec3d pivot(0.0, 0.0, 0.75);
  cv::Matx33d world_from_board;
  cv::Rodrigues(turn, world_from_board);
  cv::Matx33d camera_from_world;
  cv::Rodrigues(cv::Vec3d(0.1 * camera, angle, 0.0), camera_from_world);
  const cv::Matx33d r = camera_from_world * world_from_board;
  const cv::Vec3d t = camera_from_world * (place - pivot) + pivot;
  return k * cv::Matx33d(
                 r(0, 0), r(0, 1), t[0], r(1, 0), r(1, 1), t[1], r(2, 0), r(2, 1), t[2]);
}

std::string videos_in(const std::string& folders) {
  std::string videos;
  for (int c = 0; c < kCameras; ++c) {
    const std::string number = std::to_string(c);
    videos += (c > 0 ? ", cam" : "cam") + number + " = \"" + folders + number + "\"";
  }
  return videos;
}

cv::Mat look_at(const cv::Mat& board, int camera, double moment) {
  const double m = 0.01 / kPixelsPerCm;
  const cv::Matx33d board_from_print(m,
                                     0.0,
                                     -0.5 * m * (board.cols - 1),
                                     0.0,
                                     m,
                                     -0.5 * m * (board.rows - 1),
                                     0.0,
                                     0.0,
                                     1.0);
  // Twice as large, then halved: edges are then as soft as a lens makes them.
  const cv::Matx33d twice(2.0, 0.0, 0.5, 0.0, 2.0, 0.5, 0.0, 0.0, 1.0);
  cv::Mat large(960, 1280, CV_8UC1, cv::Scalar(120));
  cv::Mat print;
  cv::GaussianBlur(board, print, {}, 1.5);
  cv::warpPerspective(print,
                      large,
                      twice * picture_from_board(camera, moment) * board_from_print,
                      large.size(),
                      cv::INTER_LINEAR,
                      cv::BORDER_TRANSPARENT);
  cv::Mat picture;
  cv::resize(large, picture, {640, 480}, 0.0, 0.0, cv::INTER_AREA);
  return picture;
}

}  // namespace

cv::Mat painted_charuco() {
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_100);
  cv::Mat picture;
  cv::aruco::CharucoBoard::create(8, 6, 4.0F, 3.0F, dictionary)
      ->draw({pixels(32) + 2 * kMargin, pixels(24) + 2 * kMargin}, picture, kMargin);
  return picture;
}

cv::Mat painted_chessboard() {
  cv::Mat picture = white(36, 24);
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 9; ++column) {
      if ((row + column) % 2 == 0) continue;
      picture(
          {kMargin + pixels(4 * column), kMargin + pixels(4 * row), pixels(4), pixels(4)})
          .setTo(20);
    }
  }
  return picture;
}

cv::Mat painted_april_grid(int first_id) {
  cv::Mat picture = white(30, 22);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      const int id = first_id + 4 * (2 - row) + column;
      tag(id, pixels(6))
          .copyTo(picture({kMargin + pixels(8 * column),
                           kMargin + pixels(8 * row),
                           pixels(6),
                           pixels(6)}));
    }
  }
  return picture;
}

std::string charuco_table() {
  return "[board]\ntype = \"charuco\"\nrows = 6\ncolumns = 8\nsquare_size_m = 0.04\n"
         "marker_size_m = 0.03\ndictionary = \"DICT_5X5_100\"\n";
}

std::string chessboard_table() {
  return "[board]\ntype = \"chessboard\"\nrows = 6\ncolumns = 9\nsquare_size_m = 0.04\n";
}

std::string april_grid_table() {
  return "[board]\nrows = 3\ncolumns = 4\ntag_size_m = 0.06\ngap_m = 0.02\nfirst_id = "
         "0\n";
}

PaintedSession::PaintedSession(std::string board) : board_(std::move(board)) {}

fs::path PaintedSession::picture(int camera, int frame) const {
  char name[32];
  std::snprintf(name, sizeof(name), "seen%d/%03d.png", camera, frame);
  return folder_.path() / name;
}

void PaintedSession::film(const cv::Mat& board, int frames, const Path& moment) {
  frames_ = frames;
  for (int c = 0; c < kCameras; ++c) {
    fs::create_directories(picture(c, 0).parent_path());
    for (int k = 0; k < frames; ++k) {
      const double at = moment ? moment(k) : k;
      EXPECT_TRUE(cv::imwrite(picture(c, k).string(), look_at(board, c, at)));
    }
  }
}

void PaintedSession::change(int camera, const std::function<void(cv::Mat&, int)>& how) {
  for (int k = 0; k < frames_; ++k) {
    const std::string file = picture(camera, k).string();
    cv::Mat seen = cv::imread(file, cv::IMREAD_GRAYSCALE);
    how(seen, k);
    EXPECT_TRUE(cv::imwrite(file, seen));
  }
}

void PaintedSession::change_all(const std::function<void(cv::Mat&, int)>& how) {
  for (int c = 0; c < kCameras; ++c) change(c, how);
}

void PaintedSession::add_floor(const std::function<void(cv::Mat&)>& how) {
  floor_ = "[[trial]]\nname = \"floor\"\nkind = \"floor\"\nfps = 5\nvideos = { " +
           videos_in("floor") + " }\n";
  for (int c = 0; c < kCameras; ++c) {
    const fs::path place = folder_.path() / ("floor" + std::to_string(c));
    fs::create_directories(place);
    cv::Mat seen = cv::imread(picture(c, 0).string(), cv::IMREAD_GRAYSCALE);
    how(seen);
    EXPECT_TRUE(cv::imwrite((place / "000.png").string(), seen));
  }
}

ProgramRun PaintedSession::calibrate() const {
  std::ofstream file(folder_ / "session.toml");
  file << "format = 1\nname = \"painted\"\n" << board_;
  for (int c = 0; c < kCameras; ++c) file << "[[camera]]\nname = \"cam" << c << "\"\n";
  file << "[[trial]]\nname = \"calib\"\nkind = \"calibration\"\nfps = 5\nvideos = { "
       << videos_in("seen") << " }\n"
       << floor_ << more_;
  file.close();
  return run_program(marey::testing::program(),
                     {"calibrate",
                      (folder_ / "session.toml").string(),
                      "--out",
                      (folder_ / "out").string()});
}

bool PaintedSession::has_result(const std::string& name) const {
  return fs::exists(folder_.path() / "out" / name);
}

void paint_worn_tags(cv::Mat& picture) {
  for (int i = 0; i < 8; ++i) {
    constexpr int kSide = 48;
    const int x = 16 + 78 * i;
    picture({x - 8, 408, kSide + 16, kSide + 16}).setTo(235);
    tag(40 + i, kSide).copyTo(picture({x, 416, kSide, kSide}));
  }
}

std::string worn_tags_table() {
  std::string words = "[subject]\nname = \"someone\"\nstature_m = 1.7\n";
  for (int i = 0; i < 8; ++i) {
    words += "[[tags.tag]]\nid = " + std::to_string(40 + i) +
             "\nsegment = \"hips\"\nsize_m = 0.06\n";
  }
  return words;
}

}  // namespace marey::testing
