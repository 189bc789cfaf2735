// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "calib/model/calibrated_rig.h"
#include "core/base/ids.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/transform.h"

namespace marey::calib {

/// Returns new_from_old: the transform to a world on the floor, for a rig whose world has
/// no known floor.
///
/// Up is perpendicular to the horizontal image axes of all cameras: cameras on stands
/// have no roll, although they look down. A degree of roll causes a degree of slope.
/// Needs at least two cameras that do not look along one line. The floor contains the
/// lowest corner of any tag in `standing`, a trial without motion, that at least two
/// cameras see (one camera if the tag's size is known). The origin is below the mean of
/// all tags, and Z points from there to the first camera.
///
/// Returns nullopt if all cameras have the same direction, fewer than three tags are
/// placed, a camera would be below the floor, or the first camera is vertically above the
/// origin. Precondition: one detections entry per camera.
[[nodiscard]] std::optional<RigidTransform> up_from_tags(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> standing,
    const std::map<TagId, double>& sizes_m = {});

/// Returns the same transform, computed from tags that lie on the floor: the floor is the
/// plane through their corners, and the cameras are above it. Returns nullopt if two
/// cameras place fewer than two tags, any tag is more than two centimetres off the plane,
/// cameras are on both sides of the plane, or the first camera is vertically above the
/// origin. Precondition: as up_from_tags().
[[nodiscard]] std::optional<RigidTransform> up_from_floor_tags(
    std::span<const Camera> cameras, std::span<const CameraDetections> lying);

/// Returns the centres of tags at rest, in the world [m]: tags that two cameras see, or
/// one camera if their size is known. Precondition: one detections entry per camera.
[[nodiscard]] std::map<TagId, glm::dvec3> tags_at_rest(
    std::span<const Camera> cameras,
    std::span<const CameraDetections> standing,
    const std::map<TagId, double>& sizes_m);

/// Transforms a rig to a new world: its cameras, sightings and covariance.
void move_world(const RigidTransform& new_from_old, CalibratedRig& rig);

}  // namespace marey::calib
