// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "calib/board_views.h"
#include "core/camera.h"
#include "core/transform.h"

namespace marey::calib {

/// First estimate of one camera's intrinsics from its views of a flat board (OpenCV's
/// Zhang method, at most 40 views picked for spread); bundle adjustment refines it.
///
/// nullopt when the views cannot tell: fewer than four with six tags, or all square on,
/// so that focal length and distance cannot be told apart.
[[nodiscard]] std::optional<Intrinsics> estimate_intrinsics(
    std::span<const BoardView* const> views, int width_px, int height_px);

/// Where the board stands before a camera of known intrinsics, by the better of the two
/// planar solutions (Collins & Bartoli 2014, IPPE), refined. nullopt when it would lie
/// behind the camera or fewer than eight corners are seen.
[[nodiscard]] std::optional<RigidTransform> camera_from_board(
    const Intrinsics& intrinsics, const BoardView& view);

}  // namespace marey::calib
