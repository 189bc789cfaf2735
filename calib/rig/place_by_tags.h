// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: initial poses of cameras, of a moving body's tags and of static tags,
// before refinement.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "calib/model/rig_model.h"
#include "core/camera.h"

namespace marey::calib {

/// Estimates a lens from single tags of any size, using only that each is a square.
/// Searches focal lengths from a third of the image width to three times the width (for
/// fisheyes, to once) for the one at which the tags are closest to squares. Distortion is
/// zero, except the fisheye's own projection. Returns nullopt if fewer than eight tags
/// are seen or none of them is tilted enough.
[[nodiscard]] std::optional<Intrinsics> estimate_intrinsics_from_tags(
    std::span<const Sighting* const> sightings,
    LensModel lens,
    int width_px,
    int height_px);

/// Fills in camera poses, the layout of every target with pieces, and the targets' poses
/// at each instant, from intrinsics and sightings of tags. The world is the frame of the
/// camera with the most sightings. Cameras are joined by tags of known size that two
/// cameras see at once, best-supported pair first. Then tags of unknown size on a static
/// target are triangulated, and place further cameras that see enough of them.
///
/// Returns which cameras have a pose. Pieces, instants and sightings without one are
/// unchanged. Cost: a second for ten cameras and a hundred instants.
[[nodiscard]] std::vector<bool> place_by_tags(RigModel& model);

}  // namespace marey::calib
