// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// OpenCV's stereo photographs of a chessboard, with its own corners and with ours: its
// published figures belong to a search window of 11 px, wider than the squares allow.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "benchmarks/calibration/calibration_cases.h"
#include "calib/rig/calibrate_cameras.h"
#include "capture/boards/find_board_points.h"

namespace marey::calib {
namespace {

// Its inner corners are as many as OpenCV's 9 x 6.
const Chessboard kBoard{.rows = 7, .columns = 10, .square_size_m = 1.0};

/// Corners as OpenCV finds them, from the picture's top: rows turned over for our board.
std::vector<PointDetection> opencv_corners(const cv::Mat& picture, int window_px) {
  std::vector<cv::Point2f> corners;
  if (!cv::findChessboardCorners(picture, {9, 6}, corners)) return {};
  cv::cornerSubPix(picture,
                   corners,
                   {window_px, window_px},
                   {-1, -1},
                   {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-4});
  std::vector<PointDetection> points(54);
  for (int i = 0; i < 54; ++i) {
    const int point = 9 * (5 - i / 9) + i % 9;
    const cv::Point2f& corner = corners[static_cast<std::size_t>(i)];
    points[static_cast<std::size_t>(point)] = {point, {corner.x, corner.y}, 0.3};
  }
  return points;
}

std::vector<PointDetection> our_corners(const cv::Mat& picture) {
  static auto finder = capture::BoardFinder::create(kBoard);
  if (!finder) return {};
  capture::GrayFrame frame;
  frame.pixels = picture.data;
  frame.width_px = picture.cols;
  frame.height_px = picture.rows;
  frame.stride = static_cast<int>(picture.step);
  return finder->find(frame);
}

/// `window_px` 0: ours.
std::vector<CameraDetections> find(const std::filesystem::path& folder, int window_px) {
  std::vector<CameraDetections> cameras;
  for (const std::string side : {"left", "right"}) {
    CameraDetections camera;
    camera.source = side;
    camera.camera = CameraId{static_cast<int>(cameras.size())};
    for (int i = 1; i <= 14; ++i) {
      const auto file =
          folder / (side + (i < 10 ? "0" : "") + std::to_string(i) + ".jpg");
      if (!std::filesystem::exists(file)) continue;
      FrameDetections frame;
      frame.frame = static_cast<int>(camera.frames.size());
      const cv::Mat picture = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
      if (picture.empty()) continue;
      camera.width_px = picture.cols;
      camera.height_px = picture.rows;
      frame.points =
          window_px > 0 ? opencv_corners(picture, window_px) : our_corners(picture);
      camera.frames.push_back(frame);
    }
    cameras.push_back(camera);
  }
  return cameras;
}

}  // namespace

int measure_stereo(const std::filesystem::path& folder) {
  for (const int window_px : {11, 5, 0}) {
    const auto waved = find(folder, window_px);
    for (const LensModel lens : {LensModel::kBrownConrady, LensModel::kRational}) {
      CalibrateOptions options;
      options.lens = lens;
      options.cross_validate = true;
      const auto rig = calibrate_cameras(
          std::vector<std::string>{"left", "right"}, waved, {}, kBoard, options);
      std::printf("%s corners (window %d px), %s\n",
                  window_px > 0 ? "OpenCV's" : "our",
                  window_px,
                  lens == LensModel::kRational ? "8 terms" : "5 terms");
      if (!rig) {
        std::printf("%s\n", rig.error().message().c_str());
        return 1;
      }
      print_rig(*rig);
      std::printf("baseline %.4f squares\n",
                  glm::distance(centre_in_world(rig->cameras[0]),
                                centre_in_world(rig->cameras[1])));
      print_cross_validation(*rig);
    }
  }
  return 0;
}

}  // namespace marey::calib
