// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/model/planar_pose.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <opencv2/calib3d.hpp>

#include "core/base/assert.h"

namespace marey::calib {
namespace {

RigidTransform to_transform(const cv::Mat& rotation_vector_rad,
                            const cv::Mat& translation) {
  const auto at = [](const cv::Mat& m, int i) {
    return to_single_precision(m.at<double>(i));
  };
  return {rotation_from_vector({at(rotation_vector_rad, 0),
                                at(rotation_vector_rad, 1),
                                at(rotation_vector_rad, 2)}),
          {at(translation, 0), at(translation, 1), at(translation, 2)}};
}

/// Returns camera_from_plane by IPPE and refinement, computed in the frame `print`.
std::vector<RigidTransform> solve_plane(std::span<const glm::dvec2> rays,
                                        std::span<const glm::dvec3> p_in_plane,
                                        const RigidTransform& plane_from_print) {
  std::vector<cv::Point2f> image;
  std::vector<cv::Point3f> object;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const glm::dvec3 p = inverse(plane_from_print) * p_in_plane[i];
    image.emplace_back(static_cast<float>(rays[i].x), static_cast<float>(rays[i].y));
    object.emplace_back(static_cast<float>(p.x), static_cast<float>(p.y), 0.0F);
  }
  std::vector<RigidTransform> poses;
  try {
    std::vector<cv::Mat> rotations;
    std::vector<cv::Mat> translations;
    cv::solvePnPGeneric(object,
                        image,
                        cv::Matx33d::eye(),
                        cv::noArray(),
                        rotations,
                        translations,
                        false,
                        cv::SOLVEPNP_IPPE);
    for (std::size_t i = 0; i < rotations.size(); ++i) {
      cv::solvePnPRefineLM(object,
                           image,
                           cv::Matx33d::eye(),
                           cv::noArray(),
                           rotations[i],
                           translations[i]);
      poses.push_back(to_transform(rotations[i], translations[i]) *
                      inverse(plane_from_print));
    }
  } catch (const cv::Exception&) {
    return {};
  }
  return poses;
}

/// Returns the root mean square distance of the rays, at z = 1, from their points;
/// nullopt for a plane that is not in front of the camera.
std::optional<double> misfit_of(std::span<const glm::dvec2> rays,
                                std::span<const glm::dvec3> p_in_plane,
                                const RigidTransform& camera_from_plane) {
  double sum = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const glm::dvec3 p = camera_from_plane * p_in_plane[i];
    // Also rejects NaN.
    if (!(p.z > 0.0)) return std::nullopt;
    const glm::dvec2 off = glm::dvec2(p) / p.z - rays[i];
    sum += glm::dot(off, off);
  }
  return std::sqrt(sum / static_cast<double>(rays.size()));
}

bool are_alike(const RigidTransform& a, const RigidTransform& b) {
  return glm::length(rotation_vector(glm::conjugate(a.rotation) * b.rotation)) < 1e-2;
}

}  // namespace

std::vector<PlacedPlane> place_plane(const Intrinsics& intrinsics,
                                     std::span<const glm::dvec3> p_in_plane,
                                     std::span<const glm::dvec2> pixels_px) {
  MAREY_ASSERT(p_in_plane.size() == pixels_px.size());
  std::vector<glm::dvec2> rays;
  std::vector<glm::dvec3> points;
  for (std::size_t i = 0; i < pixels_px.size(); ++i) {
    const auto ray = unproject(intrinsics, pixels_px[i]);
    if (!ray) continue;
    rays.push_back(*ray);
    points.push_back(p_in_plane[i]);
  }
  if (rays.size() < 4) return {};
  std::vector<PlacedPlane> placed;
  for (const double quarter_rad : {0.0, 0.5 * std::numbers::pi}) {
    // A frame in which an upright board is hardly rotated, and one rotated by a quarter
    // turn: OpenCV's IPPE fails for rotations near half a turn, such as that from the
    // board's own frame (z out of its face) to an upright camera in front of it.
    const RigidTransform plane_from_print{
        rotation_from_vector({std::numbers::pi, 0.0, 0.0}) *
            rotation_from_vector({0.0, 0.0, quarter_rad}),
        glm::dvec3(0.0)};
    for (const RigidTransform& pose : solve_plane(rays, points, plane_from_print)) {
      const auto misfit = misfit_of(rays, points, pose);
      if (!misfit) continue;
      const bool is_known =
          std::any_of(placed.begin(), placed.end(), [&](const PlacedPlane& p) {
            return are_alike(p.camera_from_plane, pose);
          });
      if (!is_known) placed.push_back({pose, *misfit});
    }
  }
  std::stable_sort(
      placed.begin(), placed.end(), [](const PlacedPlane& a, const PlacedPlane& b) {
        return a.misfit < b.misfit;
      });
  if (placed.size() > 2) placed.resize(2);
  return placed;
}

std::optional<RigidTransform> resect(const Intrinsics& intrinsics,
                                     std::span<const glm::dvec3> p_in_world,
                                     std::span<const glm::dvec2> pixels_px) {
  MAREY_ASSERT(p_in_world.size() == pixels_px.size());
  constexpr int kMin = 6;
  std::vector<cv::Point2d> image;
  std::vector<cv::Point3d> object;
  for (std::size_t i = 0; i < pixels_px.size(); ++i) {
    const auto ray = unproject(intrinsics, pixels_px[i]);
    if (!ray) continue;
    image.emplace_back(ray->x, ray->y);
    object.emplace_back(p_in_world[i].x, p_in_world[i].y, p_in_world[i].z);
  }
  if (image.size() < kMin) return std::nullopt;
  const double near = 4.0 / std::min(intrinsics.focal_px.x, intrinsics.focal_px.y);
  try {
    cv::Mat rotation;
    cv::Mat translation;
    std::vector<int> inliers;
    cv::setRNGSeed(1);
    const bool found = cv::solvePnPRansac(object,
                                          image,
                                          cv::Matx33d::eye(),
                                          cv::noArray(),
                                          rotation,
                                          translation,
                                          false,
                                          300,
                                          static_cast<float>(near),
                                          0.999,
                                          inliers,
                                          cv::SOLVEPNP_SQPNP);
    if (!found || inliers.size() < kMin) return std::nullopt;
    std::vector<cv::Point2d> good_image;
    std::vector<cv::Point3d> good_object;
    for (const int i : inliers) {
      good_image.push_back(image[static_cast<std::size_t>(i)]);
      good_object.push_back(object[static_cast<std::size_t>(i)]);
    }
    cv::solvePnPRefineLM(good_object,
                         good_image,
                         cv::Matx33d::eye(),
                         cv::noArray(),
                         rotation,
                         translation);
    return to_transform(rotation, translation);
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
}

std::optional<glm::dvec3> nearest_to_rays(std::span<const glm::dvec3> origins,
                                          std::span<const glm::dvec3> directions) {
  MAREY_ASSERT(origins.size() == directions.size());
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d side = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const Eigen::Vector3d o(origins[i].x, origins[i].y, origins[i].z);
    const Eigen::Vector3d d =
        Eigen::Vector3d(directions[i].x, directions[i].y, directions[i].z).normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - d * d.transpose();
    sum += across;
    side += across * o;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(sum);
  // About the squared sine of the largest angle between rays.
  if (origins.size() < 2 || eigen.eigenvalues()[0] < 3e-4) return std::nullopt;
  const Eigen::Vector3d p = sum.ldlt().solve(side);
  return glm::dvec3(p.x(), p.y(), p.z());
}

}  // namespace marey::calib
