// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "calib/calibrated_rig.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/ids.h"
#include "core/transform.h"

namespace marey::calib {

/// A world that stands on a floor, for a rig whose world nobody laid down: new_from_old.
///
/// Up is across all cameras' horizontal axes, as cameras on stands are level though they
/// look down (a degree of roll is a degree of slope); of two cameras or more that do not
/// look along one line. The lowest corner of any tag that at least two cameras see in
/// `standing`, a trial in which nothing moves, or one when its size is known, is on the
/// floor; the origin is below the middle of all, and Z points from there to the first
/// camera.
///
/// nullopt when cameras are all alike turned, fewer than three tags are placed, a camera
/// would stand below the floor, or the first straight above the origin. Precondition: one
/// detections entry per camera.
[[nodiscard]] std::optional<RigidTransform> level_by_tags(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> standing,
    const std::map<TagId, double>& sizes_m = {});

/// Likewise by tags that lie on the floor: it is the plane through their corners, up is
/// where the cameras are. nullopt when fewer than two tags are placed by two cameras, any
/// is more than two centimetres off the plane, there are cameras on both sides of it, or
/// the first stands straight above the origin. Precondition: as level_by_tags()'s.
[[nodiscard]] std::optional<RigidTransform> level_by_lying_tags(
    std::span<const Camera> cameras, std::span<const CameraDetections> lying);

/// Middles of tags at rest, in the world [m]: of those that two cameras see, or one when
/// their size is known. Precondition: one detections entry per camera.
[[nodiscard]] std::map<TagId, glm::dvec3> tags_at_rest(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> standing,
    const std::map<TagId, double>& sizes_m);

/// Moves a rig's world: its cameras, what they saw and their covariance.
void move_world(const RigidTransform& new_from_old, CalibratedRig& rig);

}  // namespace marey::calib
