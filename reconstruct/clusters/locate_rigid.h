// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/camera.h"
#include "core/detection.h"
#include "core/transform.h"

namespace marey::reconstruct {

/// One camera's observation of one known point of a rigid body.
struct RigidPointView {
  const Camera* camera = nullptr;  ///< Borrowed; must outlive the call.
  glm::dvec3 p_in_body{0.0};       ///< [m]
  glm::dvec2 pixel_px{0.0};
  double sigma_px = 0.3;
};

struct RigidPose {
  RigidTransform world_from_body;
  double rms_px = 0.0;  ///< Root mean square distance of the views to their model.
  /// Robust cost of the best pose from another start that ended elsewhere, divided by
  /// this one's; a large value is unambiguous, a value near 1 means planar ambiguity: the
  /// mirrored tilt fits equally well. Infinite if all starts ended here.
  double ambiguity_ratio = 0.0;
};

/// Appends the four corner views of one sighting of a tag.
void append_corner_views(const Camera& camera,
                         const TagDetection& tag,
                         double size_m,
                         const RigidTransform& body_from_tag,
                         std::vector<RigidPointView>& views);

/// Computes the two poses in the world from which a flat square looks alike to a single
/// camera (Collins & Bartoli 2014 explain why there are two), in no particular order: one
/// solves the homography, the other is its tilt mirrored about the line of sight, a start
/// for locate_rigid(). Empty if a corner cannot be undistorted or the square is
/// degenerate.
[[nodiscard]] std::vector<RigidTransform> planar_candidates(const Camera& camera,
                                                            const TagDetection& tag,
                                                            double size_m);

/// Computes the same two, or nullopt; does not allocate.
[[nodiscard]] std::optional<std::array<RigidTransform, 2>> planar_poses(
    const Camera& camera, const TagDetection& tag, double size_m);

/// Computes the pose of a rigid body that best explains all views, by Levenberg-Marquardt
/// on the reprojection error (Huber at 3 sigma) from each of `starts`; returns the best
/// result.
/// nullopt if no start converges in front of the cameras or there are fewer than four
/// views. Pure; linear in views and starts.
[[nodiscard]] std::optional<RigidPose> locate_rigid(
    std::span<const RigidPointView> views, std::span<const RigidTransform> starts);

/// Computes the same; overwrites `starts` with their results and does not allocate.
/// Precondition: at most kMaxStarts.
inline constexpr std::size_t kMaxStarts = 32;
[[nodiscard]] std::optional<RigidPose> locate_rigid_in_place(
    std::span<const RigidPointView> views, std::span<RigidTransform> starts);

}  // namespace marey::reconstruct
