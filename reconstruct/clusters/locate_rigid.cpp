// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/clusters/locate_rigid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <ceres/jet.h>
#include <glm/geometric.hpp>

#include "core/base/assert.h"

namespace marey::reconstruct {
namespace {

using Jet = ceres::Jet<double, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kHuber = 3.0;  // [sigma]
constexpr double kBehindCamera = std::numeric_limits<double>::infinity();

double huber(double r2) {
  return r2 <= kHuber * kHuber ? r2 : 2.0 * kHuber * std::sqrt(r2) - kHuber * kHuber;
}

/// Returns the sum of robust squared residuals. [sigma^2]
double cost_of(std::span<const RigidPointView> views, const RigidTransform& pose) {
  double cost = 0.0;
  for (const RigidPointView& view : views) {
    const auto pixel = project(*view.camera, pose * view.p_in_body);
    if (!pixel) return kBehindCamera;
    const glm::dvec2 r = (*pixel - view.pixel_px) / view.sigma_px;
    cost += huber(glm::dot(r, r));
  }
  return cost;
}

/// Computes the normal equations of a small motion of the body: rotation vector in the
/// world about the body's origin, then translation.
bool linearise(std::span<const RigidPointView> views,
               const RigidTransform& pose,
               Matrix6& hessian,
               Vector6& gradient) {
  hessian.setZero();
  gradient.setZero();
  for (const RigidPointView& view : views) {
    const glm::dvec3 arm = pose.rotation * view.p_in_body;
    const RigidTransform& c = view.camera->camera_from_world;
    const glm::dvec3 p = c * (arm + pose.translation);
    std::array<Jet, 3> p_in_camera{Jet(p.x), Jet(p.y), Jet(p.z)};
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 unit(0.0);
      unit[axis] = 1.0;
      const glm::dvec3 turned = c.rotation * glm::cross(unit, arm);
      const glm::dvec3 moved = c.rotation * unit;
      for (int i = 0; i < 3; ++i) {
        p_in_camera[static_cast<std::size_t>(i)].v[axis] = turned[i];
        p_in_camera[static_cast<std::size_t>(i)].v[axis + 3] = moved[i];
      }
    }
    std::array<Jet, 2> pixel;
    if (!project(view.camera->intrinsics, p_in_camera.data(), pixel.data())) return false;
    const double rx = (pixel[0].a - view.pixel_px.x) / view.sigma_px;
    const double ry = (pixel[1].a - view.pixel_px.y) / view.sigma_px;
    const double norm = std::sqrt(rx * rx + ry * ry);
    const double weight =
        (norm <= kHuber ? 1.0 : kHuber / norm) / (view.sigma_px * view.sigma_px);
    for (const Jet& component : pixel) {
      hessian += weight * component.v * component.v.transpose();
    }
    gradient += weight * view.sigma_px * (rx * pixel[0].v + ry * pixel[1].v);
  }
  return true;
}

RigidTransform moved(const RigidTransform& pose, const Vector6& step) {
  return {
      glm::normalize(rotation_from_vector({step[0], step[1], step[2]}) * pose.rotation),
      pose.translation + glm::dvec3(step[3], step[4], step[5])};
}

/// Runs Levenberg-Marquardt from one start; returns the final cost.
double refine(std::span<const RigidPointView> views, RigidTransform& pose) {
  double cost = cost_of(views, pose);
  double damping = 1e-3;
  for (int iteration = 0; iteration < 30 && std::isfinite(cost); ++iteration) {
    Matrix6 hessian;
    Vector6 gradient;
    if (!linearise(views, pose, hessian, gradient)) return kBehindCamera;
    bool improved = false;
    for (int attempt = 0; attempt < 8 && !improved; ++attempt) {
      Matrix6 damped = hessian;
      damped.diagonal() *= 1.0 + damping;
      damped.diagonal().array() += 1e-12;
      const RigidTransform candidate = moved(pose, -damped.ldlt().solve(gradient));
      const double candidate_cost = cost_of(views, candidate);
      if (candidate_cost < cost) {
        improved = cost - candidate_cost > 1e-9 * cost;
        pose = candidate;
        cost = candidate_cost;
        damping = std::max(1e-9, damping * 0.2);
        if (!improved) return cost;
      } else {
        damping *= 10.0;
      }
    }
    if (!improved) return cost;
  }
  return cost;
}

std::optional<RigidTransform> camera_from_square(const Intrinsics& intrinsics,
                                                 const TagDetection& tag,
                                                 double size_m) {
  // Direct linear transform: four corners give the homography exactly.
  Eigen::Matrix<double, 8, 8> a;
  Eigen::Matrix<double, 8, 1> b;
  for (int i = 0; i < 4; ++i) {
    const auto ray = unproject(intrinsics, tag.corners_px[static_cast<std::size_t>(i)]);
    if (!ray) return std::nullopt;
    const glm::dvec3 p = corner_in_tag(i, size_m);
    a.row(2 * i) << p.x, p.y, 1, 0, 0, 0, -ray->x * p.x, -ray->x * p.y;
    a.row(2 * i + 1) << 0, 0, 0, p.x, p.y, 1, -ray->y * p.x, -ray->y * p.y;
    b[2 * i] = ray->x;
    b[2 * i + 1] = ray->y;
  }
  const Eigen::Matrix<double, 8, 1> h = a.fullPivLu().solve(b);
  const Eigen::Vector3d h1(h[0], h[3], h[6]);
  const Eigen::Vector3d h2(h[1], h[4], h[7]);
  const Eigen::Vector3d h3(h[2], h[5], 1.0);
  const double scale = 0.5 * (h1.norm() + h2.norm());
  if (!std::isfinite(scale) || scale < 1e-9) return std::nullopt;
  Eigen::Matrix3d rough;
  rough << h1 / scale, h2 / scale, (h1 / scale).cross(h2 / scale);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rough,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  if (rotation.determinant() < 0.0) return std::nullopt;
  const Eigen::Quaterniond q(rotation);
  const Eigen::Vector3d t = h3 / scale;
  return RigidTransform{{q.w(), q.x(), q.y(), q.z()}, {t.x(), t.y(), t.z()}};
}

/// Refines every start in place and returns the best; `costs` has one entry per start.
std::optional<RigidPose> best_end(std::span<const RigidPointView> views,
                                  std::span<RigidTransform> starts,
                                  std::span<double> costs) {
  if (views.size() < 4) return std::nullopt;
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    costs[i] = refine(views, starts[i]);
    if (!std::isfinite(costs[i])) continue;
    if (!best || costs[i] < costs[*best]) best = i;
  }
  if (!best) return std::nullopt;
  const RigidTransform& pose = starts[*best];
  double runner_up = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < starts.size(); ++i) {
    if (!std::isfinite(costs[i])) continue;
    const double turn_rad =
        glm::length(rotation_vector(glm::conjugate(pose.rotation) * starts[i].rotation));
    if (turn_rad > 0.1) runner_up = std::min(runner_up, costs[i]);
  }
  double sum = 0.0;
  for (const RigidPointView& view : views) {
    const glm::dvec2 r = *project(*view.camera, pose * view.p_in_body) - view.pixel_px;
    sum += glm::dot(r, r);
  }
  return RigidPose{pose,
                   std::sqrt(sum / static_cast<double>(views.size())),
                   runner_up / std::max(costs[*best], 1e-9)};
}

}  // namespace

void append_corner_views(const Camera& camera,
                         const TagDetection& tag,
                         double size_m,
                         const RigidTransform& body_from_tag,
                         std::vector<RigidPointView>& views) {
  for (int i = 0; i < 4; ++i) {
    views.push_back({&camera,
                     body_from_tag * corner_in_tag(i, size_m),
                     tag.corners_px[static_cast<std::size_t>(i)],
                     tag.sigma_px});
  }
}

std::optional<std::array<RigidTransform, 2>> planar_poses(const Camera& camera,
                                                          const TagDetection& tag,
                                                          double size_m) {
  const auto camera_from_tag = camera_from_square(camera.intrinsics, tag, size_m);
  if (!camera_from_tag) return std::nullopt;
  const RigidTransform world_from_camera = inverse(camera.camera_from_world);
  // The other solution: the normal mirrored about the line of sight.
  const glm::dvec3 sight = glm::normalize(camera_from_tag->translation);
  const glm::dvec3 normal = camera_from_tag->rotation * glm::dvec3(0, 0, 1);
  const glm::dvec3 mirrored = 2.0 * glm::dot(normal, sight) * sight - normal;
  RigidTransform other = *camera_from_tag;
  other.rotation = rotation_between(normal, mirrored) * other.rotation;
  return std::array{world_from_camera * *camera_from_tag, world_from_camera * other};
}

std::vector<RigidTransform> planar_candidates(const Camera& camera,
                                              const TagDetection& tag,
                                              double size_m) {
  const auto both = planar_poses(camera, tag, size_m);
  if (!both) return {};
  return {both->begin(), both->end()};
}

std::optional<RigidPose> locate_rigid(std::span<const RigidPointView> views,
                                      std::span<const RigidTransform> starts) {
  std::vector<RigidTransform> ends(starts.begin(), starts.end());
  std::vector<double> costs(starts.size());
  return best_end(views, ends, costs);
}

std::optional<RigidPose> locate_rigid_in_place(std::span<const RigidPointView> views,
                                               std::span<RigidTransform> starts) {
  MAREY_ASSERT(starts.size() <= kMaxStarts);
  std::array<double, kMaxStarts> costs{};
  return best_end(views, starts, std::span(costs).first(starts.size()));
}

}  // namespace marey::reconstruct
