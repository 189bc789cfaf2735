// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "calib/board_views.h"
#include "core/camera.h"
#include "core/transform.h"

namespace marey::calib {

/// First estimate of one camera's intrinsics from its views of a flat board, at most 40
/// picked for spread over the picture, distance and tilt: OpenCV's Zhang method, for
/// fisheyes cv::fisheye's. Bundle adjustment refines it. The rational model starts with
/// Brown and Conrady's terms.
///
/// nullopt when the views cannot tell: fewer than four with six tags (or a dozen points),
/// or all square on, so that focal length and distance cannot be told apart.
[[nodiscard]] std::optional<Intrinsics> estimate_intrinsics(
    std::span<const BoardView* const> views,
    int width_px,
    int height_px,
    LensModel lens = LensModel::kBrownConrady);

/// Where the board stands before a camera of known intrinsics, by the better of the two
/// planar solutions. nullopt when it would lie behind the camera or fewer than six
/// corners are seen.
[[nodiscard]] std::optional<RigidTransform> camera_from_board(
    const Intrinsics& intrinsics, const BoardView& view);

}  // namespace marey::calib
