// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/detection.h"
#include "core/transform.h"

namespace marey {

/// Pinhole with Brown-Conrady distortion, OpenCV's five-term model.
/// Camera frame: x right, y down, z forward. Pixel centres at integers.
struct Intrinsics {
  /// What a solver moves: focal x, y [px]; centre x, y [px]; k1, k2, p1, p2, k3.
  static constexpr int kParameterCount = 9;

  int width_px = 0;
  int height_px = 0;
  glm::dvec2 focal_px{1000.0};
  glm::dvec2 centre_px{0.0};
  std::array<double, 5> distortion{};  ///< k1, k2, p1, p2, k3 (OpenCV's order).

  [[nodiscard]] std::array<double, kParameterCount> parameters() const;
  void set_parameters(std::span<const double, kParameterCount> values);
};

/// A camera at rest in the world.
struct Camera {
  std::string name;
  Intrinsics intrinsics;
  RigidTransform camera_from_world;
  TagShrinkage tag_shrinkage;  ///< Of the tags it sees.
};

/// Pixel of a point in the camera's frame [m]. `parameters` as in Intrinsics,
/// `p_in_camera` 3 numbers, `pixel_px` 2. P and T are double, or ceres::Jet inside a
/// residual (P stays double when the intrinsics are not being solved for): there is no
/// second copy of this formula. False, with `pixel_px` untouched, when the point is not
/// in front of the camera. Source: D. C. Brown, "Close-range camera calibration", 1971,
/// as OpenCV writes it.
template <class P, class T>
[[nodiscard]] bool project(const P* parameters, const T* p_in_camera, T* pixel_px) {
  if (!(p_in_camera[2] > T(1e-6))) return false;  // Nor is NaN in front of anything.
  const T x = p_in_camera[0] / p_in_camera[2];
  const T y = p_in_camera[1] / p_in_camera[2];
  const T r2 = x * x + y * y;
  const T radial = 1.0 + r2 * (parameters[4] + r2 * (parameters[5] + r2 * parameters[8]));
  const P& p1 = parameters[6];
  const P& p2 = parameters[7];
  const T xy = 2.0 * x * y;
  const T xd = x * radial + xy * p1 + (r2 + 2.0 * x * x) * p2;
  const T yd = y * radial + (r2 + 2.0 * y * y) * p1 + xy * p2;
  pixel_px[0] = xd * parameters[0] + parameters[2];
  pixel_px[1] = yd * parameters[1] + parameters[3];
  return true;
}

/// project() with fixed intrinsics.
template <class T>
[[nodiscard]] bool project(const Intrinsics& intrinsics,
                           const T* p_in_camera,
                           T* pixel_px) {
  return project(intrinsics.parameters().data(), p_in_camera, pixel_px);
}

/// Pixel of a world point; nullopt when it is not in front of the camera. The pixel may
/// lie outside the image.
[[nodiscard]] std::optional<glm::dvec2> project(const Camera& camera,
                                                const glm::dvec3& p_in_world);

/// The point at z = 1 in the camera's frame whose projection is `pixel_px`: the inverse
/// of project(), by Newton's method. nullopt when it does not converge, or only where the
/// distortion has folded the picture over: both happen only far outside the image of a
/// strongly distorted lens.
[[nodiscard]] std::optional<glm::dvec2> unproject(const Intrinsics& intrinsics,
                                                  const glm::dvec2& pixel_px);

/// Where the camera stands, in world coordinates [m].
[[nodiscard]] inline glm::dvec3 centre_in_world(const Camera& camera) {
  return inverse(camera.camera_from_world).translation;
}

}  // namespace marey
