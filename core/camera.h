// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/detection.h"
#include "core/transform.h"

namespace marey {

/// Distortion model of a lens. The names and the orders of the terms are OpenCV's.
enum class LensModel : unsigned char {
  kBrownConrady,  ///< k1, k2, p1, p2, k3
  kRational,      ///< k1, k2, p1, p2, k3, k4, k5, k6
  kFisheye,       ///< k1, k2, k3, k4 of the angle from the axis (equidistant)
};

/// Returns the number of distortion terms of `lens`.
[[nodiscard]] constexpr std::size_t distortion_terms(LensModel lens) {
  switch (lens) {
    case LensModel::kBrownConrady:
      return 5;
    case LensModel::kRational:
      return 8;
    case LensModel::kFisheye:
      return 4;
  }
  return 0;
}

/// Intrinsic parameters of a camera. Camera frame: x right, y down, z forward. Pixel
/// centres at integers.
struct Intrinsics {
  /// The parameters that a solver estimates: focal x, y [px]; centre x, y [px]; the
  /// distortion terms. Terms that the lens does not have are at the end and zero.
  static constexpr int kParameterCount = 12;

  int width_px = 0;
  int height_px = 0;
  glm::dvec2 focal_px{1000.0};
  glm::dvec2 centre_px{0.0};
  std::array<double, 8> distortion{};  ///< The first distortion_terms(lens) count.
  LensModel lens = LensModel::kBrownConrady;

  [[nodiscard]] std::array<double, kParameterCount> parameters() const;
  void set_parameters(std::span<const double, kParameterCount> values);
};

/// A camera at rest in the world.
struct Camera {
  std::string name;
  Intrinsics intrinsics;
  RigidTransform camera_from_world;
  TagShrinkage tag_shrinkage;  ///< Shrinkage of the tags that it sees.
};

/// Projects a point in the camera's frame [m] to a pixel. `parameters` as in Intrinsics,
/// `p_in_camera` 3 numbers, `pixel_px` 2. P and T are double, or ceres::Jet inside a
/// residual (P stays double if the intrinsics are not estimated): there is no second copy
/// of these formulas. Returns false, with `pixel_px` untouched, when the point is not in
/// front of the camera or the rational model has no value there. Sources: D. C. Brown,
/// "Close-range camera calibration", 1971, and for fisheyes J. Kannala and S. Brandt, "A
/// generic camera model and calibration method", 2006, eq. 6, both as OpenCV writes them.
template <class P, class T>
[[nodiscard]] bool project(LensModel lens,
                           const P* parameters,
                           const T* p_in_camera,
                           T* pixel_px) {
  using std::atan2;
  using std::sqrt;
  if (!(p_in_camera[2] > T(1e-6))) return false;  // Also false for NaN.
  const T x = p_in_camera[0] / p_in_camera[2];
  const T y = p_in_camera[1] / p_in_camera[2];
  const T r2 = x * x + y * y;
  const P* k = parameters + 4;
  T xd = x;
  T yd = y;
  if (lens == LensModel::kFisheye) {
    // On the axis the root has no derivative; there the angle is the radius.
    if (r2 > T(1e-16)) {
      const T r = sqrt(r2);
      const T angle = atan2(r, T(1.0));
      const T a2 = angle * angle;
      const T bent = angle * (1.0 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
      xd = x * bent / r;
      yd = y * bent / r;
    }
  } else {
    T radial = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    if (lens == LensModel::kRational) {
      const T below = 1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
      if (!(below > T(1e-6))) return false;
      radial = radial / below;
    }
    const P& p1 = k[2];
    const P& p2 = k[3];
    const T xy = 2.0 * x * y;
    xd = x * radial + xy * p1 + (r2 + 2.0 * x * x) * p2;
    yd = y * radial + (r2 + 2.0 * y * y) * p1 + xy * p2;
  }
  pixel_px[0] = xd * parameters[0] + parameters[2];
  pixel_px[1] = yd * parameters[1] + parameters[3];
  return true;
}

/// Projects with fixed intrinsics.
template <class T>
[[nodiscard]] bool project(const Intrinsics& intrinsics,
                           const T* p_in_camera,
                           T* pixel_px) {
  return project(intrinsics.lens, intrinsics.parameters().data(), p_in_camera, pixel_px);
}

/// Returns the pixel of a world point; nullopt when it is not in front of the camera. The
/// pixel may lie outside the image.
[[nodiscard]] std::optional<glm::dvec2> project(const Camera& camera,
                                                const glm::dvec3& p_in_world);

/// Returns the point at z = 1 in the camera's frame whose projection is `pixel_px`: the
/// inverse of project(), by Newton's method. nullopt when it does not converge, or only
/// where the distortion has folded the picture over: both happen only far outside the
/// image of a strongly distorted lens.
[[nodiscard]] std::optional<glm::dvec2> unproject(const Intrinsics& intrinsics,
                                                  const glm::dvec2& pixel_px);

/// Returns the camera's optical centre in world coordinates [m].
[[nodiscard]] inline glm::dvec3 centre_in_world(const Camera& camera) {
  return inverse(camera.camera_from_world).translation;
}

}  // namespace marey
