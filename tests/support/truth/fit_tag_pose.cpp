// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/truth/fit_tag_pose.h"

#include <cstddef>
#include <stdexcept>

#include "core/detection.h"

namespace marey::testing {
namespace {

using Vector6 = std::array<double, 6>;

RigidTransform moved(const RigidTransform& world_from_tag, const Vector6& step) {
  return {rotation_from_vector({step[0], step[1], step[2]}) * world_from_tag.rotation,
          world_from_tag.translation + glm::dvec3(step[3], step[4], step[5])};
}

glm::dvec2 seen(const Camera& camera, const RigidTransform& pose, int c, double size_m) {
  const auto pixel = project(camera, pose * corner_in_tag(c, size_m));
  if (!pixel) throw std::runtime_error("the tag went behind a camera");
  return *pixel;
}

/// By elimination without pivoting. Precondition: positive definite.
Vector6 solve(std::array<Vector6, 6> a, Vector6 b) {
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t i = k + 1; i < 6; ++i) {
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < 6; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = 6; k-- > 0;) {
    for (std::size_t j = k + 1; j < 6; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

}  // namespace

RigidTransform fit_tag_pose(std::span<const TagView> views,
                            double size_m,
                            RigidTransform world_from_tag) {
  constexpr int kSteps = 6;
  constexpr double kNudge = 1e-6;  // For differences: rad and m.
  for (int step = 0; step < kSteps; ++step) {
    std::array<Vector6, 6> normal{};
    Vector6 right{};
    for (const TagView& view : views) {
      const double weight = 1.0 / (view.sigma_px * view.sigma_px);
      for (int c = 0; c < 4; ++c) {
        const glm::dvec2 here = seen(*view.camera, world_from_tag, c, size_m);
        const glm::dvec2 miss = view.corners_px[static_cast<std::size_t>(c)] - here;
        std::array<glm::dvec2, 6> by{};
        for (std::size_t k = 0; k < 6; ++k) {
          Vector6 nudge{};
          nudge[k] = kNudge;
          by[k] = (seen(*view.camera, moved(world_from_tag, nudge), c, size_m) - here) /
                  kNudge;
        }
        for (std::size_t i = 0; i < 6; ++i) {
          right[i] += weight * (by[i].x * miss.x + by[i].y * miss.y);
          for (std::size_t j = 0; j < 6; ++j) {
            normal[i][j] += weight * (by[i].x * by[j].x + by[i].y * by[j].y);
          }
        }
      }
    }
    world_from_tag = moved(world_from_tag, solve(normal, right));
  }
  return world_from_tag;
}

}  // namespace marey::testing
