// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/level_world.h"

#include <algorithm>
#include <array>
#include <vector>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "calib/judge_rig.h"
#include "calib/planar_pose.h"
#include "calib/see_point.h"
#include "core/assert.h"
#include "core/quantile.h"

namespace marey::calib {
namespace {

/// The direction across all cameras' own x axes; of its two signs, that of their tops.
std::optional<glm::dvec3> up_of(std::span<const Camera> cameras) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  glm::dvec3 tops(0.0);
  for (const Camera& camera : cameras) {
    const glm::dquat world_from_camera = inverse(camera.camera_from_world).rotation;
    const Eigen::Vector3d right = to_eigen(world_from_camera * glm::dvec3(1, 0, 0));
    sum += right * right.transpose();
    tops += world_from_camera * glm::dvec3(0, -1, 0);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(sum);
  // The squared sine of ten degrees between axes, about.
  if (cameras.size() < 2 || eigen.eigenvalues()[1] < 0.015) return std::nullopt;
  const Eigen::Vector3d across = eigen.eigenvectors().col(0);
  const glm::dvec3 up(across.x(), across.y(), across.z());
  return glm::dot(up, tops) > 0.0 ? up : -up;
}

/// Corners of tags, triangulated from the median of what each camera saw.
std::vector<glm::dvec3> corners_of(std::span<const Camera> cameras,
                                   std::span<const CameraDetections> standing) {
  struct Rays {
    std::vector<glm::dvec3> origins;
    std::vector<glm::dvec3> directions;
  };
  std::map<std::pair<TagId, std::size_t>, Rays> rays;
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    std::map<std::pair<TagId, std::size_t>, std::array<std::vector<double>, 2>> pixels;
    for (const FrameDetections& frame : standing[c].frames) {
      for (const TagDetection& tag : frame.tags) {
        for (std::size_t i = 0; i < 4; ++i) {
          pixels[{tag.id, i}][0].push_back(tag.corners_px[i].x);
          pixels[{tag.id, i}][1].push_back(tag.corners_px[i].y);
        }
      }
    }
    const RigidTransform world_from_camera = inverse(cameras[c].camera_from_world);
    for (auto& [corner, xy] : pixels) {
      const glm::dvec2 middle(median(std::move(xy[0])), median(std::move(xy[1])));
      const auto ray = unproject(cameras[c].intrinsics, middle);
      if (!ray) continue;
      rays[corner].origins.push_back(world_from_camera.translation);
      rays[corner].directions.push_back(world_from_camera.rotation *
                                        glm::dvec3(*ray, 1.0));
    }
  }
  std::vector<glm::dvec3> corners;
  for (const auto& [corner, r] : rays) {
    if (const auto p = nearest_to_rays(r.origins, r.directions)) corners.push_back(*p);
  }
  return corners;
}

}  // namespace

std::optional<RigidTransform> level_by_tags(std::span<const Camera> cameras,
                                            std::span<const CameraDetections> standing) {
  MAREY_ASSERT(cameras.size() == standing.size());
  const auto up = up_of(cameras);
  const std::vector<glm::dvec3> corners = corners_of(cameras, standing);
  if (!up || corners.size() < 12) return std::nullopt;
  glm::dvec3 middle(0.0);
  double lowest = glm::dot(corners.front(), *up);
  for (const glm::dvec3& p : corners) {
    middle += p / static_cast<double>(corners.size());
    lowest = std::min(lowest, glm::dot(p, *up));
  }
  for (const Camera& camera : cameras) {
    if (glm::dot(centre_in_world(camera), *up) <= lowest) return std::nullopt;
  }
  const glm::dvec3 origin = middle + (lowest - glm::dot(middle, *up)) * *up;
  glm::dvec3 ahead = centre_in_world(cameras[0]) - origin;
  ahead -= glm::dot(ahead, *up) * *up;
  if (glm::length(ahead) < 1e-3) return std::nullopt;
  const glm::dvec3 z = glm::normalize(ahead);
  const glm::dquat old_from_new =
      glm::normalize(glm::quat_cast(glm::dmat3(glm::cross(*up, z), *up, z)));
  return inverse(RigidTransform{old_from_new, origin});
}

void move_world(const RigidTransform& new_from_old, CalibratedRig& rig) {
  for (Camera& camera : rig.cameras) {
    camera.camera_from_world = camera.camera_from_world * inverse(new_from_old);
  }
  turn_covariance(new_from_old.rotation, rig.covariance);
}

}  // namespace marey::calib
