// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "calib/rig/estimate_world_up.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "calib/model/planar_pose.h"
#include "calib/model/project_point.h"
#include "calib/rig/make_calibrated_rig.h"
#include "core/base/assert.h"
#include "core/base/quantile.h"

namespace marey::calib {
namespace {

/// Returns the direction perpendicular to all cameras' x axes, with the sign of their
/// upper sides.
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
  // About the squared sine of ten degrees between axes.
  if (cameras.size() < 2 || eigen.eigenvalues()[1] < 0.015) return std::nullopt;
  const Eigen::Vector3d across = eigen.eigenvectors().col(0);
  const glm::dvec3 up(across.x(), across.y(), across.z());
  return glm::dot(up, tops) > 0.0 ? up : -up;
}

/// Corners of a tag at rest in one camera: the median over its frames.
using SeenCorners = std::map<TagId, std::array<glm::dvec2, 4>>;

SeenCorners corners_at_rest(const CameraDetections& standing) {
  std::map<TagId, std::array<std::array<std::vector<double>, 2>, 4>> pixels;
  for (const FrameDetections& frame : standing.frames) {
    for (const TagDetection& tag : frame.tags) {
      for (std::size_t i = 0; i < 4; ++i) {
        pixels[tag.id][i][0].push_back(tag.corners_px[i].x);
        pixels[tag.id][i][1].push_back(tag.corners_px[i].y);
      }
    }
  }
  SeenCorners seen;
  for (auto& [id, corners] : pixels) {
    for (std::size_t i = 0; i < 4; ++i) {
      seen[id][i] = {median(std::move(corners[i][0])), median(std::move(corners[i][1]))};
    }
  }
  return seen;
}

/// Returns the world positions of the corners of a tag of known size in one camera.
std::vector<glm::dvec3> corners_of_one_view(const Camera& camera,
                                            const std::array<glm::dvec2, 4>& corners_px,
                                            double size_m) {
  std::array<glm::dvec3, 4> corners{};
  for (int i = 0; i < 4; ++i) {
    corners[static_cast<std::size_t>(i)] = corner_in_tag(i, size_m);
  }
  const auto planes = place_plane(camera.intrinsics, corners, corners_px);
  std::vector<glm::dvec3> out;
  if (planes.empty()) return out;
  const RigidTransform world_from_tag =
      inverse(camera.camera_from_world) * planes[0].camera_from_plane;
  for (const glm::dvec3& p : corners) out.push_back(world_from_tag * p);
  return out;
}

/// Returns the corners of tags: triangulated from several cameras; from a single view
/// with the tag's size.
std::map<TagId, std::vector<glm::dvec3>> corners_by_tag(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> standing,
    const std::map<TagId, double>& sizes_m) {
  std::vector<SeenCorners> seen;
  std::map<TagId, int> views;
  for (const CameraDetections& camera : standing) {
    seen.push_back(corners_at_rest(camera));
    for (const auto& [id, corners] : seen.back()) ++views[id];
  }
  std::map<TagId, std::vector<glm::dvec3>> corners;
  for (const auto& [id, count] : views) {
    const auto size = sizes_m.find(id);
    std::array<std::vector<glm::dvec3>, 4> origins;
    std::array<std::vector<glm::dvec3>, 4> directions;
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      const auto found = seen[c].find(id);
      if (found == seen[c].end()) continue;
      if (count == 1 && size != sizes_m.end()) {
        corners[id] = corners_of_one_view(cameras[c], found->second, size->second);
      }
      const RigidTransform world_from_camera = inverse(cameras[c].camera_from_world);
      for (std::size_t i = 0; i < 4; ++i) {
        const auto ray = unproject(cameras[c].intrinsics, found->second[i]);
        if (!ray) continue;
        origins[i].push_back(world_from_camera.translation);
        directions[i].push_back(world_from_camera.rotation * glm::dvec3(*ray, 1.0));
      }
    }
    for (std::size_t i = 0; i < 4; ++i) {
      if (const auto p = nearest_to_rays(origins[i], directions[i])) {
        corners[id].push_back(*p);
      }
    }
  }
  return corners;
}

std::vector<glm::dvec3> corners_of(std::span<const Camera> cameras,
                                   std::span<const CameraDetections> standing,
                                   const std::map<TagId, double>& sizes_m) {
  std::vector<glm::dvec3> all;
  for (const auto& [id, own] : corners_by_tag(cameras, standing, sizes_m)) {
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

/// Returns the world with this origin and up direction, Z pointing to the first camera.
/// Returns nullopt if that camera is vertically above.
std::optional<RigidTransform> facing_first(std::span<const Camera> cameras,
                                           const glm::dvec3& origin,
                                           const glm::dvec3& up) {
  glm::dvec3 ahead = centre_in_world(cameras[0]) - origin;
  ahead -= glm::dot(ahead, up) * up;
  if (glm::length(ahead) < 1e-3) return std::nullopt;
  const glm::dvec3 z = glm::normalize(ahead);
  const glm::dquat old_from_new =
      glm::normalize(glm::quat_cast(glm::dmat3(glm::cross(up, z), up, z)));
  return inverse(RigidTransform{old_from_new, origin});
}

}  // namespace

std::optional<RigidTransform> up_from_tags(std::span<const Camera> cameras,
                                           std::span<const CameraDetections> standing,
                                           const std::map<TagId, double>& sizes_m) {
  MAREY_ASSERT(cameras.size() == standing.size());
  if (cameras.empty()) return std::nullopt;
  const auto up = up_of(cameras);
  const std::vector<glm::dvec3> corners = corners_of(cameras, standing, sizes_m);
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
  return facing_first(cameras, origin, *up);
}

std::optional<RigidTransform> up_from_floor_tags(
    std::span<const Camera> cameras, std::span<const CameraDetections> lying) {
  MAREY_ASSERT(cameras.size() == lying.size());
  const std::vector<glm::dvec3> corners = corners_of(cameras, lying, {});
  if (corners.size() < 8) return std::nullopt;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const glm::dvec3& p : corners) {
    middle += Eigen::Vector3d(p.x, p.y, p.z) / static_cast<double>(corners.size());
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const glm::dvec3& p : corners) {
    const Eigen::Vector3d d = Eigen::Vector3d(p.x, p.y, p.z) - middle;
    spread += d * d.transpose() / static_cast<double>(corners.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread);
  const Eigen::Vector3d across = eigen.eigenvectors().col(0);
  const glm::dvec3 origin(middle.x(), middle.y(), middle.z());
  glm::dvec3 up(across.x(), across.y(), across.z());
  constexpr double kFlat_m = 0.02;
  for (const glm::dvec3& p : corners) {
    if (std::abs(glm::dot(p - origin, up)) > kFlat_m) return std::nullopt;
  }
  if (glm::dot(centre_in_world(cameras[0]) - origin, up) < 0.0) up = -up;
  for (const Camera& camera : cameras) {
    if (glm::dot(centre_in_world(camera) - origin, up) <= 0.0) return std::nullopt;
  }
  return facing_first(cameras, origin, up);
}

std::map<TagId, glm::dvec3> tags_at_rest(std::span<const Camera> cameras,
                                         std::span<const CameraDetections> standing,
                                         const std::map<TagId, double>& sizes_m) {
  MAREY_ASSERT(cameras.size() == standing.size());
  std::map<TagId, glm::dvec3> middles;
  for (const auto& [id, corners] : corners_by_tag(cameras, standing, sizes_m)) {
    if (corners.size() != 4) continue;
    middles[id] = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  }
  return middles;
}

void move_world(const RigidTransform& new_from_old, CalibratedRig& rig) {
  for (Camera& camera : rig.cameras) {
    camera.camera_from_world = camera.camera_from_world * inverse(new_from_old);
  }
  for (TargetView& view : rig.views) {
    view.world_from_target = new_from_old * view.world_from_target;
  }
  turn_covariance(new_from_old.rotation, rig.covariance);
}

}  // namespace marey::calib
