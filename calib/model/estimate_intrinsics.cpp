// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/estimate_intrinsics.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <opencv2/calib3d.hpp>

#include "calib/model/planar_pose.h"

namespace marey::calib {
namespace {

constexpr std::size_t kMaxViews = 40;
constexpr std::size_t kMinViews = 4;
constexpr std::size_t kMinTagCorners = 24;
constexpr std::size_t kMinPoints = 12;

std::vector<cv::Point3f> object_points(const BoardView& view) {
  std::vector<cv::Point3f> points;
  for (const BoardCorner& c : view.corners) {
    points.emplace_back(static_cast<float>(c.p_in_board.x),
                        static_cast<float>(c.p_in_board.y),
                        static_cast<float>(c.p_in_board.z));
  }
  return points;
}

/// Returns true if some view shows the board tilted out of the image plane. In a frontal
/// view, twice the focal length at twice the distance gives the same image.
bool is_tilted_somewhere(const cv::Mat& rotation_vectors_rad) {
  // [rad] Smallest tilt of a hand-held board in practice.
  constexpr double kTilted = 0.1;
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

/// Selects views by farthest-point sampling over the board's position and size in the
/// image: neighbouring frames of a slow motion are redundant.
std::vector<const BoardView*> spread_views(std::vector<const BoardView*> views) {
  if (views.size() <= kMaxViews) return views;
  const auto feature = [](const BoardView& v) {
    double longest = 0.0;
    double across = 0.0;
    const glm::dvec2 middle = middle_px(v);
    for (const BoardCorner& c : v.corners) {
      longest = std::max(longest, glm::distance(c.pixel_px, middle));
      across += glm::distance(c.pixel_px, middle);
    }
    // A tilted board is narrow for its length.
    return glm::dvec4(
        middle, longest, 3.0 * across / static_cast<double>(v.corners.size()));
  };
  std::vector<const BoardView*> chosen{views.front()};
  std::vector<double> gap(views.size(), 1e300);
  while (chosen.size() < kMaxViews) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      gap[i] =
          std::min(gap[i], glm::distance(feature(*views[i]), feature(*chosen.back())));
    }
    const auto farthest = std::max_element(gap.begin(), gap.end()) - gap.begin();
    chosen.push_back(views[static_cast<std::size_t>(farthest)]);
  }
  return chosen;
}

/// Zhang's method. Principal point and tangential terms are left to the bundle: they are
/// unstable with partial views of a board.
struct Zhang {
  cv::Mat matrix;
  cv::Mat distortion;
  cv::Mat rotations;  ///< Rotation vectors, per view.
};

std::optional<Zhang> zhang(const std::vector<std::vector<cv::Point3f>>& object,
                           const std::vector<std::vector<cv::Point2f>>& image,
                           cv::Size size,
                           LensModel lens) {
  Zhang out;
  cv::Mat translations;
  try {
    if (lens == LensModel::kFisheye) {
      // Starts with a field of view of about 60 degrees: the solver does not converge
      // from an arbitrary start.
      const double focal = size.width / 1.8;
      out.matrix = (cv::Mat_<double>(3, 3) << focal,
                    0,
                    0.5 * (size.width - 1),
                    0,
                    focal,
                    0.5 * (size.height - 1),
                    0,
                    0,
                    1);
      out.distortion = cv::Mat::zeros(4, 1, CV_64F);
      cv::fisheye::calibrate(
          object,
          image,
          size,
          out.matrix,
          out.distortion,
          out.rotations,
          translations,
          cv::fisheye::CALIB_USE_INTRINSIC_GUESS |
              cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW |
              cv::fisheye::CALIB_FIX_PRINCIPAL_POINT | cv::fisheye::CALIB_FIX_K2 |
              cv::fisheye::CALIB_FIX_K3 | cv::fisheye::CALIB_FIX_K4);
    } else {
      cv::calibrateCamera(object,
                          image,
                          size,
                          out.matrix,
                          out.distortion,
                          out.rotations,
                          translations,
                          cv::CALIB_FIX_K2 | cv::CALIB_FIX_K3 |
                              cv::CALIB_ZERO_TANGENT_DIST |
                              cv::CALIB_FIX_PRINCIPAL_POINT);
    }
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  return out;
}

}  // namespace

std::optional<Intrinsics> estimate_intrinsics(std::span<const BoardView* const> views,
                                              int width_px,
                                              int height_px,
                                              LensModel lens) {
  std::vector<const BoardView*> good;
  for (const BoardView* view : views) {
    const std::size_t min_corners = view->of_tags ? kMinTagCorners : kMinPoints;
    if (view->corners.size() >= min_corners) good.push_back(view);
  }
  good = spread_views(std::move(good));
  if (good.size() < kMinViews) return std::nullopt;
  std::vector<std::vector<cv::Point3f>> object;
  std::vector<std::vector<cv::Point2f>> image;
  for (const BoardView* view : good) {
    object.push_back(object_points(*view));
    image.push_back(image_points(*view));
  }
  const auto found = zhang(object, image, {width_px, height_px}, lens);
  if (!found) return std::nullopt;
  Intrinsics k;
  k.lens = lens;
  k.width_px = width_px;
  k.height_px = height_px;
  const auto at = [&](int row, int column) {
    return to_single_precision(found->matrix.at<double>(row, column));
  };
  k.focal_px = {at(0, 0), at(1, 1)};
  k.centre_px = {at(0, 2), at(1, 2)};
  k.distortion[0] = to_single_precision(found->distortion.at<double>(0));
  const double focal = k.focal_px.x / width_px;
  const bool sane = std::isfinite(focal) && focal > 0.2 && focal < 10.0 &&
                    std::abs(k.focal_px.y / k.focal_px.x - 1.0) < 0.2;
  if (!sane || !is_tilted_somewhere(found->rotations)) return std::nullopt;
  return k;
}

std::optional<RigidTransform> camera_from_board(const Intrinsics& intrinsics,
                                                const BoardView& view) {
  std::vector<glm::dvec3> p_in_board;
  std::vector<glm::dvec2> pixels_px;
  for (const BoardCorner& corner : view.corners) {
    p_in_board.push_back(corner.p_in_board);
    pixels_px.push_back(corner.pixel_px);
  }
  if (pixels_px.size() < 6) return std::nullopt;
  const auto placed = place_plane(intrinsics, p_in_board, pixels_px);
  if (placed.empty()) return std::nullopt;
  return placed[0].camera_from_plane;
}

}  // namespace marey::calib
