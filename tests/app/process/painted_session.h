// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::testing {

/// A board's printed face, in grey, a centimetre being kPixelsPerCm pixels.
inline constexpr double kPixelsPerCm = 40.0;

/// 8 x 6 squares of 4 cm with markers of 3 cm, ids from 0.
[[nodiscard]] cv::Mat painted_charuco();
/// 9 x 6 squares of 4 cm.
[[nodiscard]] cv::Mat painted_chessboard();
/// 4 x 3 tags of 6 cm, 2 cm apart, of tag36h11 from `first_id`.
[[nodiscard]] cv::Mat painted_april_grid(int first_id = 0);

/// Returns the [board] table of session.toml for each of these boards.
[[nodiscard]] std::string charuco_table();
[[nodiscard]] std::string chessboard_table();
[[nodiscard]] std::string april_grid_table();

/// A calibration of three cameras, painted: a board moves before them and is seen by the
/// pinhole that each is, of 640 x 480 px. Its files go with it.
class PaintedSession {
 public:
  /// `board` is the [board] table with its header, whatever is filmed.
  explicit PaintedSession(std::string board);

  /// Place of the board in frame k: the usual way is to and fro, near, far and tilted.
  using Path = std::function<double(int frame)>;
  /// Films it. `moment` maps frames to places along the usual path; the frame itself,
  /// when there is none.
  void film(const cv::Mat& board, int frames = 16, const Path& moment = {});
  /// Changes the pictures of a camera, or of all.
  void change(int camera, const std::function<void(cv::Mat& picture, int frame)>& how);
  void change_all(const std::function<void(cv::Mat& picture, int frame)>& how);
  /// Adds words at the end of session.toml.
  void add(const std::string& words) { more_ += words; }
  /// Adds a floor trial of one frame: the first of the film, changed.
  void add_floor(const std::function<void(cv::Mat& picture)>& how);

  /// Runs `marey calibrate` on it.
  [[nodiscard]] ProgramRun calibrate() const;
  [[nodiscard]] bool has_result(const std::string& name) const;

 private:
  [[nodiscard]] std::filesystem::path picture(int camera, int frame) const;

  ScratchFolder folder_;
  std::string board_;
  std::string more_;
  std::string floor_;
  int frames_ = 0;
};

/// Tags as a body wears them: ids 40 to 47 of tag36h11, along the picture's lower edge.
void paint_worn_tags(cv::Mat& picture);
/// The session's words about them.
[[nodiscard]] std::string worn_tags_table();

}  // namespace marey::testing
