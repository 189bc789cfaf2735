// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/estimate_intrinsics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <opencv2/calib3d.hpp>

namespace marey::calib {
namespace {

constexpr std::size_t kMostViews = 40;
constexpr std::size_t kFewestViews = 4;
constexpr std::size_t kFewestCorners = 24;

std::vector<cv::Point3f> object_points(const BoardView& view) {
  std::vector<cv::Point3f> points;
  for (const BoardCorner& c : view.corners) {
    points.emplace_back(static_cast<float>(c.p_in_board.x),
                        static_cast<float>(c.p_in_board.y),
                        static_cast<float>(c.p_in_board.z));
  }
  return points;
}

/// Whether some view shows the board turned away from the image plane. Square on, twice
/// the focal length at twice the distance is the same picture.
bool is_tilted_somewhere(const cv::Mat& rotation_vectors_rad) {
  constexpr double kTilted = 0.1;  // [rad] A hand cannot hold a board straighter.
  for (int i = 0; i < static_cast<int>(rotation_vectors_rad.total()); ++i) {
    const auto& r = rotation_vectors_rad.at<cv::Vec3d>(i);
    const glm::dvec3 face =
        rotation_from_vector({r[0], r[1], r[2]}) * glm::dvec3(0, 0, 1);
    if (std::hypot(face.x, face.y) > std::sin(kTilted)) return true;
  }
  return false;
}

std::vector<cv::Point2f> image_points(const BoardView& view) {
  std::vector<cv::Point2f> points;
  for (const BoardCorner& c : view.corners) {
    points.emplace_back(static_cast<float>(c.pixel_px.x),
                        static_cast<float>(c.pixel_px.y));
  }
  return points;
}

glm::dvec2 middle_px(const BoardView& view) {
  glm::dvec2 sum(0.0);
  for (const BoardCorner& c : view.corners) sum += c.pixel_px;
  return sum / static_cast<double>(view.corners.size());
}

/// Farthest-point choice over where the board is in the image and how large it is there:
/// neighbouring frames of a slow wave say the same thing twice.
std::vector<const BoardView*> spread_views(std::vector<const BoardView*> views) {
  if (views.size() <= kMostViews) return views;
  const auto feature = [](const BoardView& v) {
    double extent = 0.0;
    for (const BoardCorner& c : v.corners) {
      extent = std::max(extent, glm::distance(c.pixel_px, v.corners[0].pixel_px));
    }
    return glm::dvec3(middle_px(v), extent);
  };
  std::vector<const BoardView*> chosen{views.front()};
  std::vector<double> gap(views.size(), 1e300);
  while (chosen.size() < kMostViews) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      gap[i] =
          std::min(gap[i], glm::distance(feature(*views[i]), feature(*chosen.back())));
    }
    const auto farthest = std::max_element(gap.begin(), gap.end()) - gap.begin();
    chosen.push_back(views[static_cast<std::size_t>(farthest)]);
  }
  return chosen;
}

RigidTransform to_transform(const cv::Mat& rotation_vector_rad,
                            const cv::Mat& translation) {
  const auto at = [](const cv::Mat& m, int i) { return m.at<double>(i); };
  return {rotation_from_vector({at(rotation_vector_rad, 0),
                                at(rotation_vector_rad, 1),
                                at(rotation_vector_rad, 2)}),
          {at(translation, 0), at(translation, 1), at(translation, 2)}};
}

/// camera_from_board by IPPE and refinement, solved for in the frame `print`.
std::optional<RigidTransform> solve_plane(std::span<const glm::dvec2> rays,
                                          std::span<const glm::dvec3> p_in_board,
                                          const RigidTransform& board_from_print) {
  std::vector<cv::Point2f> image;
  std::vector<cv::Point3f> object;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const glm::dvec3 p = inverse(board_from_print) * p_in_board[i];
    image.emplace_back(static_cast<float>(rays[i].x), static_cast<float>(rays[i].y));
    object.emplace_back(static_cast<float>(p.x), static_cast<float>(p.y), 0.0F);
  }
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  try {
    cv::solvePnPGeneric(object,
                        image,
                        cv::Matx33d::eye(),
                        cv::noArray(),
                        rotations,
                        translations,
                        false,
                        cv::SOLVEPNP_IPPE);
    if (rotations.empty()) return std::nullopt;
    cv::solvePnPRefineLM(
        object, image, cv::Matx33d::eye(), cv::noArray(), rotations[0], translations[0]);
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  return to_transform(rotations[0], translations[0]) * inverse(board_from_print);
}

/// Sum of squared distances of the rays, at z = 1, to their points. Infinite for a board
/// that is not before the camera.
double misfit_of(std::span<const glm::dvec2> rays,
                 std::span<const glm::dvec3> p_in_board,
                 const RigidTransform& camera_from_board) {
  double sum = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const glm::dvec3 p = camera_from_board * p_in_board[i];
    // Also of a pose that is no number.
    if (!(p.z > 0.0)) return std::numeric_limits<double>::infinity();
    const glm::dvec2 off = glm::dvec2(p) / p.z - rays[i];
    sum += glm::dot(off, off);
  }
  return sum;
}

}  // namespace

std::optional<Intrinsics> estimate_intrinsics(std::span<const BoardView* const> views,
                                              int width_px,
                                              int height_px) {
  std::vector<const BoardView*> good;
  for (const BoardView* view : views) {
    if (view->corners.size() >= kFewestCorners) good.push_back(view);
  }
  good = spread_views(std::move(good));
  if (good.size() < kFewestViews) return std::nullopt;
  std::vector<std::vector<cv::Point3f>> object;
  std::vector<std::vector<cv::Point2f>> image;
  for (const BoardView* view : good) {
    object.push_back(object_points(*view));
    image.push_back(image_points(*view));
  }
  cv::Mat matrix;
  cv::Mat distortion;
  cv::Mat rotations;
  cv::Mat translations;
  try {
    // Principal point and tangential terms wait for the bundle: with partial views of a
    // board they wander off together.
    cv::calibrateCamera(object,
                        image,
                        {width_px, height_px},
                        matrix,
                        distortion,
                        rotations,
                        translations,
                        cv::CALIB_FIX_K2 | cv::CALIB_FIX_K3 |
                            cv::CALIB_ZERO_TANGENT_DIST | cv::CALIB_FIX_PRINCIPAL_POINT);
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  Intrinsics k;
  k.width_px = width_px;
  k.height_px = height_px;
  k.focal_px = {matrix.at<double>(0, 0), matrix.at<double>(1, 1)};
  k.centre_px = {matrix.at<double>(0, 2), matrix.at<double>(1, 2)};
  k.distortion[0] = distortion.at<double>(0);
  const double focal = k.focal_px.x / width_px;
  const bool sane = std::isfinite(focal) && focal > 0.2 && focal < 10.0 &&
                    std::abs(k.focal_px.y / k.focal_px.x - 1.0) < 0.2;
  if (!sane || !is_tilted_somewhere(rotations)) return std::nullopt;
  return k;
}

std::optional<RigidTransform> camera_from_board(const Intrinsics& intrinsics,
                                                const BoardView& view) {
  std::vector<glm::dvec2> rays;
  std::vector<glm::dvec3> p_in_board;
  for (const BoardCorner& corner : view.corners) {
    const auto ray = unproject(intrinsics, corner.pixel_px);
    if (!ray) continue;
    rays.push_back(*ray);
    p_in_board.push_back(corner.p_in_board);
  }
  if (rays.size() < 8) return std::nullopt;
  std::optional<RigidTransform> best;
  double least = std::numeric_limits<double>::infinity();
  for (const double quarter_rad : {0.0, 0.5 * std::numbers::pi}) {
    // A frame in which a board seen upright is hardly turned, and one a quarter on:
    // OpenCV's IPPE loses itself where a rotation is a half turn, as from the board's own
    // frame (z out of its face) to any camera that stands upright before it.
    const RigidTransform board_from_print{
        rotation_from_vector({std::numbers::pi, 0.0, 0.0}) *
            rotation_from_vector({0.0, 0.0, quarter_rad}),
        glm::dvec3(0.0)};
    const auto pose = solve_plane(rays, p_in_board, board_from_print);
    if (!pose) continue;
    const double misfit = misfit_of(rays, p_in_board, *pose);
    if (misfit < least) {
      least = misfit;
      best = pose;
    }
  }
  return best;
}

}  // namespace marey::calib
