// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: cameras, a moving body's tags and the scenery's, before refinement.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "calib/rig_model.h"
#include "core/camera.h"

namespace marey::calib {

/// First estimate of a lens from single tags of any size, each of which is square: of the
/// focal lengths from a third of the picture's width to three times it (for fisheyes, to
/// once), the one at which they look most so. No distortion but the fisheye's own.
/// nullopt where fewer than eight tags are seen, or none of them tilted enough to tell.
[[nodiscard]] std::optional<Intrinsics> estimate_intrinsics_from_tags(
    std::span<const Sighting* const> sightings,
    LensModel lens,
    int width_px,
    int height_px);

/// Fills in cameras' poses, the layout of every target that has pieces and where targets
/// are at each instant, from intrinsics and sightings of tags. The world is the frame of
/// the camera that sees most. Cameras are joined by the tags of known size that two see
/// at once, most agreed upon first; then tags of unknown size on a target that stays are
/// triangulated, and give a place to cameras that see enough of those.
///
/// Returns which cameras have a place. Pieces, instants and sightings without one are
/// left as they were. Cost: a second for ten cameras and a hundred instants.
[[nodiscard]] std::vector<bool> place_by_tags(RigModel& model);

}  // namespace marey::calib
