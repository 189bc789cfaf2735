// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to calib: which frames of cameras that started on their own go together.

#include <cstddef>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "calib/board_views.h"
#include "core/camera.h"
#include "core/detection.h"
#include "core/transform.h"

namespace marey::calib {

/// Where a camera saw something, in its own frame: by what it was (a board is 0, of a
/// wand each tag is something of its own) and the camera's frame.
using SeenTrack = std::map<std::pair<std::size_t, int>, RigidTransform>;

/// Per camera, its offset [s] against the first one's clock, to half a frame or so: at
/// the right one, wherever two cameras see a thing they agree on where they stand to
/// each other, and at a wrong one only while it rests. Offsets of up to `most_s` either
/// way are tried, in steps of the slowest camera's frame. 0 for cameras that nothing
/// joins. Cost: some seconds.
[[nodiscard]] std::vector<double> coarse_offsets_s(
    std::span<const SeenTrack> tracks,
    std::span<const CameraDetections> waved,
    double most_s);

/// The same of a board.
[[nodiscard]] std::vector<double> coarse_offsets_s(
    std::span<const BoardView> views,
    std::span<const Intrinsics> intrinsics,
    std::span<const CameraDetections> waved,
    double most_s);

}  // namespace marey::calib
