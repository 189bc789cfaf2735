// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: coarse time offsets of cameras that were started separately.

#include <cstddef>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "calib/model/board_views.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/transform.h"

namespace marey::calib {

/// Poses of objects in one camera's frame, by object and by the camera's frame number. A
/// board is object 0; each tag of a wand is an object.
using SeenTrack = std::map<std::pair<std::size_t, int>, RigidTransform>;

/// Returns, per camera, the offset [s] relative to the first camera's clock, accurate to
/// about half a frame. At the correct offset, all shared poses agree on the cameras'
/// relative pose; at a wrong one they agree only while the object is at rest. Offsets up
/// to `max_s` in both directions are tried, in steps of the slowest camera's frame.
/// Returns 0 for cameras without shared objects. Cost: some seconds.
[[nodiscard]] std::vector<double> coarse_offsets_s(
    std::span<const SeenTrack> tracks,
    std::span<const CameraDetections> waved,
    double max_s);

/// The same for views of a board.
[[nodiscard]] std::vector<double> coarse_offsets_s(
    std::span<const BoardView> views,
    std::span<const Intrinsics> intrinsics,
    std::span<const CameraDetections> waved,
    double max_s);

}  // namespace marey::calib
