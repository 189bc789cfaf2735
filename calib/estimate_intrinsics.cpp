// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/estimate_intrinsics.h"

#include <algorithm>
#include <cmath>

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
  if (!sane) return std::nullopt;
  return k;
}

std::optional<RigidTransform> camera_from_board(const Intrinsics& intrinsics,
                                                const BoardView& view) {
  std::vector<cv::Point2f> rays;
  std::vector<cv::Point3f> object;
  const std::vector<cv::Point3f> all = object_points(view);
  for (std::size_t i = 0; i < view.corners.size(); ++i) {
    const auto ray = unproject(intrinsics, view.corners[i].pixel_px);
    if (!ray) continue;
    rays.emplace_back(static_cast<float>(ray->x), static_cast<float>(ray->y));
    object.push_back(all[i]);
  }
  if (rays.size() < 8) return std::nullopt;
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  try {
    cv::solvePnPGeneric(object,
                        rays,
                        cv::Matx33d::eye(),
                        cv::noArray(),
                        rotations,
                        translations,
                        false,
                        cv::SOLVEPNP_IPPE);
    if (rotations.empty()) return std::nullopt;
    cv::solvePnPRefineLM(
        object, rays, cv::Matx33d::eye(), cv::noArray(), rotations[0], translations[0]);
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  const RigidTransform pose = to_transform(rotations[0], translations[0]);
  if (pose.translation.z <= 0.0) return std::nullopt;
  return pose;
}

}  // namespace marey::calib
