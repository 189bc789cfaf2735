// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/camera.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace marey {
namespace {

/// Returns true if rays further out still go to pixels further out. Beyond, the
/// polynomial folds the picture over, and a pixel found there is not the image of a real
/// lens.
bool before_the_fold(const Intrinsics& intrinsics, const glm::dvec2& ray) {
  const auto& k = intrinsics.distortion;
  const double r2 = glm::dot(ray, ray);
  if (intrinsics.lens == LensModel::kFisheye) {
    const double angle = std::atan(std::sqrt(r2));
    const double a2 = angle * angle;
    return 1.0 + a2 * (3.0 * k[0] +
                       a2 * (5.0 * k[1] + a2 * (7.0 * k[2] + a2 * 9.0 * k[3]))) >
           0.0;
  }
  // r -> r * above(r^2) / below(r^2)
  const double above = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const double above_slope = k[0] + r2 * (2.0 * k[1] + r2 * 3.0 * k[4]);
  double below = 1.0;
  double below_slope = 0.0;
  if (intrinsics.lens == LensModel::kRational) {
    below += r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
    below_slope = k[5] + r2 * (2.0 * k[6] + r2 * 3.0 * k[7]);
  }
  const double slope =
      above * below + 2.0 * r2 * (above_slope * below - above * below_slope);
  return above > 0.0 && below > 0.0 && slope > 0.0;
}

/// Returns an initial guess for the ray.
glm::dvec2 first_ray(const Intrinsics& intrinsics, const glm::dvec2& pixel_px) {
  const glm::dvec2 flat = (pixel_px - intrinsics.centre_px) / intrinsics.focal_px;
  const double angle = glm::length(flat);
  if (intrinsics.lens != LensModel::kFisheye || angle < 1e-8) return flat;
  return flat * (std::tan(std::min(angle, 1.4)) / angle);
}

}  // namespace

std::array<double, Intrinsics::kParameterCount> Intrinsics::parameters() const {
  std::array<double, kParameterCount> values{
      focal_px.x, focal_px.y, centre_px.x, centre_px.y};
  std::copy(distortion.begin(), distortion.end(), values.begin() + 4);
  return values;
}

void Intrinsics::set_parameters(std::span<const double, kParameterCount> values) {
  focal_px = {values[0], values[1]};
  centre_px = {values[2], values[3]};
  std::copy(values.begin() + 4, values.end(), distortion.begin());
}

std::optional<glm::dvec2> project(const Camera& camera, const glm::dvec3& p_in_world) {
  const glm::dvec3 p_in_camera = camera.camera_from_world * p_in_world;
  glm::dvec2 pixel_px{0.0};
  if (!project(
          camera.intrinsics, glm::value_ptr(p_in_camera), glm::value_ptr(pixel_px))) {
    return std::nullopt;
  }
  return pixel_px;
}

std::optional<glm::dvec2> unproject(const Intrinsics& intrinsics,
                                    const glm::dvec2& pixel_px) {
  const glm::dvec2 start = first_ray(intrinsics, pixel_px);
  glm::dvec2 ray = start;
  const auto image_of = [&](const glm::dvec2& r) {
    const glm::dvec3 p(r, 1.0);
    glm::dvec2 q{0.0};
    (void)project(intrinsics, glm::value_ptr(p), glm::value_ptr(q));
    return q;
  };
  for (int iteration = 0; iteration < 20; ++iteration) {
    const glm::dvec2 miss = image_of(ray) - pixel_px;
    if (glm::length(miss) < 1e-9) break;
    // Central differences: the model is smooth and the step far above rounding error.
    constexpr double kStep = 1e-6;
    const glm::dvec2 dx =
        (image_of(ray + glm::dvec2(kStep, 0)) - image_of(ray - glm::dvec2(kStep, 0))) /
        (2 * kStep);
    const glm::dvec2 dy =
        (image_of(ray + glm::dvec2(0, kStep)) - image_of(ray - glm::dvec2(0, kStep))) /
        (2 * kStep);
    const double determinant = dx.x * dy.y - dx.y * dy.x;
    if (std::abs(determinant) < 1e-12) return std::nullopt;
    ray -= glm::dvec2(dy.y * miss.x - dy.x * miss.y, dx.x * miss.y - dx.y * miss.x) /
           determinant;
    if (glm::length(ray - start) > 10.0) return std::nullopt;
  }
  const bool found = glm::length(image_of(ray) - pixel_px) < 1e-6;
  if (!found || !before_the_fold(intrinsics, ray)) return std::nullopt;
  return ray;
}

}  // namespace marey
